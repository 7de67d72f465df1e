//! Ctrl-C, SIGTERM, and SIGUSR1, by which batch systems announce that time is nearly up.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
use signal_hook::flag::{register, register_conditional_shutdown};

use crate::exit::INTERRUPTED;

/// A flag that the first of these signals sets. The second one ends the program at once.
pub(crate) fn flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM, SIGUSR1] {
        // In this order: the first signal finds the flag unset. Where it fails, signals do what they always do.
        let _ = register_conditional_shutdown(signal, INTERRUPTED.into(), Arc::clone(&flag));
        let _ = register(signal, Arc::clone(&flag));
    }
    flag
}
