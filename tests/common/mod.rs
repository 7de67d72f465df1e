//! What the tests of pages in a browser have in common.

use std::ffi::OsString;

/// Arguments that make Chromium draw WebGL without a window and without a graphics processor, a pixel of the page on each
/// pixel of a picture.
pub(crate) const BROWSER_ARGUMENTS: [&str; 6] = [
    "--headless=new",
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--hide-scrollbars",
    "--force-device-scale-factor=1",
];

/// Returns the command of Chromium.
pub(crate) fn browser() -> OsString {
    std::env::var_os("SIR_BROWSER").expect("SIR_BROWSER is the command of Chromium")
}
