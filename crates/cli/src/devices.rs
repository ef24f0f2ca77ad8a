//! `luminaire devices`.

use crate::shared::printing::{self, print};
use crate::shared::table::table;
use luminaire::Result;
use luminaire::backend::{self, DeviceReport};
use std::process::ExitCode;

/// What follows the options in `--help`.
pub const HELP: &str = "\
Examples:
  luminaire devices
      every device, what it offers, and the backend that `luminaire render` would take there
  luminaire render model.obj --device llvmpipe
      renders on the one whose name contains this

Exit codes:
  0  at least one device is usable
  1  none is; what to install is said. Or a limit of the process leaves a driver too little memory
  2  wrong usage";

/// What to do where no device is usable.
const ADVICE: &str = "\
Install the Vulkan loader and a driver. A GPU needs its vendor's driver or Mesa; Mesa's lavapipe needs no GPU:
  Debian 13, Ubuntu 24.04   apt install libvulkan1 mesa-vulkan-drivers
  Debian 12                 the same from bookworm-backports (the plain package has no ray query); `make setup` does it
  Fedora                    dnf install vulkan-loader mesa-vulkan-drivers
  Arch Linux                pacman -S vulkan-icd-loader vulkan-swrast
  Windows                   the GPU vendor's driver
Until then `luminaire render` uses the CPU reference.";

/// Prints a report; exit code 0 if any device is usable.
pub fn run() -> Result<ExitCode> {
    // Whether there is a driver is not known then, so nothing need be installed.
    backend::check_driver()?;
    let devices = match backend::devices() {
        Ok(devices) => devices,
        Err(error) => {
            printing::error(format_args!("{error}\n{ADVICE}"));
            return Ok(ExitCode::FAILURE);
        }
    };
    print(&report(&devices))?;
    if devices.iter().any(|device| device.backend.is_ok()) {
        return Ok(ExitCode::SUCCESS);
    }
    printing::error(format_args!("there is no usable Vulkan device\n{ADVICE}"));
    Ok(ExitCode::FAILURE)
}

/// One paragraph a device, and what `auto` would pick.
fn report(devices: &[DeviceReport]) -> String {
    let mut text = String::new();
    for device in devices {
        text += &format!("{}  {}\n", device.index, device.name);
        let mut rows = vec![vec!["kind".into(), device.kind.into()], vec!["driver".into(), device.driver.clone()]];
        rows.extend(device.features.iter().map(|(name, value)| vec![name.clone(), value.clone()]));
        rows.push(vec![
            "backend".into(),
            match &device.backend {
                Ok(backend) => format!("{backend}: {}", device.why),
                Err(reason) => format!("none: {reason}"),
            },
        ]);
        text += &table(3, &rows);
        text += "\n";
    }
    if let Some(best) = devices.iter().find(|d| d.preferred)
        && let Ok(backend) = &best.backend
    {
        text += &format!("auto would run {backend} on device {}, {}\n", best.index, best.name);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use luminaire::backend::Backend;

    #[test]
    fn a_report_names_devices_backends_and_reasons() {
        let device = |index: usize, kind, backend| DeviceReport {
            index,
            name: format!("Device {index}"),
            driver: "driver 1.2".into(),
            kind,
            features: vec![("ray query".into(), "yes".into())],
            backend,
            why: "it has RT cores".into(),
            preferred: index == 2,
            ray_query: true,
        };
        let devices = [
            device(0, "software (CPU)", Ok(Backend::ComputeBvh)),
            device(1, "discrete GPU", Err("no compute queue".into())),
            device(2, "integrated GPU", Ok(Backend::RayQuery)),
        ];
        let text = report(&devices);
        assert!(
            text.starts_with(
                "0  Device 0\n   kind       software (CPU)\n   driver     driver 1.2\n   ray query  yes\n"
            ),
            "{text}"
        );
        assert!(text.contains("backend    none: no compute queue"), "{text}");
        assert!(text.ends_with("auto would run ray-query on device 2, Device 2\n"), "{text}");
        assert!(!report(&devices[1..2]).contains("auto"));
    }
}
