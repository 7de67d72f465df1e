//! Handlers of Ctrl-C, SIGTERM, SIGUSR1 and SIGHUP. Batch systems send SIGUSR1 shortly before the time limit; a terminal
//! that is closed, or a connection that is lost, sends SIGHUP.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown};

use crate::exit::INTERRUPTED;

/// Signals that interrupt a run, and end the program at once if it has been interrupted before.
#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGUSR1];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Installs the handlers and returns a flag that the first signal sets. The second signal ends the program at once,
/// except for SIGHUP.
pub(crate) fn flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    for signal in SIGNALS {
        // In this order, so that the first signal finds the flag unset and does not end the program. If registering
        // fails, signals keep their previous action.
        let _ = register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::clone(&flag));
        let _ = register(signal, Arc::clone(&flag));
    }
    #[cfg(unix)]
    if !is_ignored(signal_hook::consts::SIGHUP) {
        // A closed terminal sends it several times: once by the shell, and once by the kernel.
        let _ = register(signal_hook::consts::SIGHUP, Arc::clone(&flag));
    }
    flag
}

/// Returns true if the program was started with this signal ignored, as `nohup` does with SIGHUP.
#[cfg(unix)]
#[allow(unsafe_code, reason = "no safe interface reads the action of a signal")]
fn is_ignored(signal: i32) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: without a new action, `sigaction` only writes the current one, and returns 0 once it has.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}
