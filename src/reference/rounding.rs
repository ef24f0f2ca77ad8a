//! How large rounding errors can be.

/// `n u / (1 - n u)`: bounds the relative error of `n` roundings in a row, where `u` is half an ulp of 1
/// (Higham, "Accuracy and Stability of Numerical Algorithms", section 3.1).
pub(super) fn gamma(n: f64) -> f64 {
    let nu = n * (0.5 * f64::EPSILON);
    nu / (1.0 - nu)
}
