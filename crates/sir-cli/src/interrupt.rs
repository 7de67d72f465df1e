//! Handlers of Ctrl-C, SIGTERM and SIGUSR1. Batch systems send SIGUSR1 shortly before the time limit.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag::{register, register_conditional_shutdown};

use crate::exit::INTERRUPTED;

/// Signals that interrupt a run.
#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGUSR1];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Installs the handlers and returns a flag that the first signal sets. The second signal ends the program at once.
pub(crate) fn flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    for signal in SIGNALS {
        // In this order, so that the first signal finds the flag unset and does not end the program. If registering
        // fails, signals keep their previous action.
        let _ = register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::clone(&flag));
        let _ = register(signal, Arc::clone(&flag));
    }
    flag
}
