//! A smooth dielectric over a base: how much light such a coat lets through.

/// One minus the reflectance of a smooth dielectric, averaged over directions in proportion to their cosine: `2 int_0^1 F(cos) cos dcos` is what
/// it reflects of even light. `eta` is the index of refraction on the far side over that on the near side; from the other side it is this over
/// `eta^2` (radiance over the squared index is what is kept).
///
/// By Simpson's rule, to 1e-9: Duntley's closed form (1942) cancels where `eta` is nearly 1.
pub fn coat_transmittance(eta: f64) -> f64 {
    if eta < 1.0 {
        return coat_transmittance(1.0 / eta) * (eta * eta);
    }
    const STEPS: u32 = 512;
    // The cosine is s^2, so that steps are fine near grazing, where all happens if the index is nearly 1.
    let integrand = |s: f64| {
        let cos_i = s * s;
        let cos_t = ((eta - 1.0) * (eta + 1.0) + cos_i * cos_i).sqrt() / eta;
        // At grazing, with an index of 1, zero over zero.
        let ratio = |a: f64, b: f64| if a + b > 0.0 { (a - b) / (a + b) } else { 0.0 };
        let (perpendicular, parallel) = (ratio(cos_i, eta * cos_t), ratio(eta * cos_i, cos_t));
        let reflectance = 0.5 * (perpendicular * perpendicular + parallel * parallel);
        (1.0 - reflectance) * 4.0 * s * s * s
    };
    let at = |step: u32| integrand(f64::from(step) / f64::from(STEPS));
    let odd: f64 = (1..STEPS).step_by(2).map(at).sum();
    let even: f64 = (2..STEPS).step_by(2).map(at).sum();
    (at(0) + 4.0 * odd + 2.0 * even + at(STEPS)) / (3.0 * f64::from(STEPS))
}

#[cfg(test)]
mod tests {
    use super::coat_transmittance;

    /// Duntley's formula for the reflectance of even light, "The optical properties of diffusing materials" (1942).
    fn duntley(n: f64) -> f64 {
        let (n2, n3, n4) = (n * n, n * n * n, n * n * n * n);
        0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
            + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
            - 2.0 * n3 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
            + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln()
    }

    #[test]
    fn the_average_is_the_closed_form() {
        for eta in [1.01, 1.1, 1.33, 1.5, 2.4, 10.0, 100.0] {
            let found = 1.0 - coat_transmittance(eta);
            assert!((found - duntley(eta)).abs() < 1e-8, "{eta}: {found}, {}", duntley(eta));
            let inside = coat_transmittance(1.0 / eta);
            assert!((inside * eta * eta - coat_transmittance(eta)).abs() < 1e-12, "{eta}");
        }
        assert_eq!(coat_transmittance(1.0), 1.0);
        assert!((1.0 - coat_transmittance(1.5) - 0.0918).abs() < 5e-5, "window glass");
    }
}
