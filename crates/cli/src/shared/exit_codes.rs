//! The exit codes in the help, and those that the library's errors do not give.

/// The exit codes of `luminaire` and of `luminaire render`, for their help.
pub const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    failure: a file, a scene, a device; `error:` on stderr says what and what to do
  2    wrong usage: an option, or options that do not go together
  3    the device failed while it rendered; what had been rendered until then is written, and with --checkpoint, --resume goes on
  130  interrupted (Ctrl-C or SIGTERM); what had been rendered until then is written";

/// A run that was interrupted: 128 + SIGINT, as shells have it.
pub const INTERRUPTED: u8 = 130;

/// A device failed while it rendered.
pub const DEVICE_FAILED: u8 = 3;
