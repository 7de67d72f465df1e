//! Requirements on the measurements of sensors.

use crate::text::field::Format as _;
use crate::text::formats::{Number, number, positive};
use crate::text::reader::{Fields, Reader};
use crate::text::record::record;

record! {
    /// Limits that a standard or a client requires: least values, and a largest UGR.
    pub struct Require, check Require::check {
        /// Least mean.
        pub mean: Option<f64> = positive(500.0).optional("none").unit("W/m²");
        /// Least irradiance at any sensor.
        pub minimum: Option<f64> = positive(100.0).optional("none").unit("W/m²");
        /// Least uniformity U₀, minimum/mean.
        pub uniformity: Option<f64> = ratio(0.6).optional("none");
        /// Least diversity U_d, minimum/maximum.
        pub diversity: Option<f64> = ratio(0.4).optional("none");
        /// Least mean daylight factor.
        pub daylight_factor: Option<f64> = positive(2.0).optional("none").unit("%");
        /// Largest UGR at any sensor.
        pub ugr: Option<f64> = positive(19.0).optional("none");
    }
}

fn ratio(example: f64) -> Number {
    number(example).with_range(|x| 0.0 < x && x <= 1.0, "above 0 and up to 1")
}

impl Require {
    fn check(&self, reader: &mut Reader<'_>, fields: &Fields<'_>) {
        let Self { mean, minimum, uniformity, diversity, daylight_factor, ugr } = self;
        let is_empty =
            [mean, minimum, uniformity, diversity, daylight_factor, ugr].into_iter().all(Option::is_none);
        if is_empty && !fields.has_unknown() {
            let help = "write for instance `require: (mean: 500, uniformity: 0.6)`";
            reader.problem(fields.place, "`require` states no requirement", help);
        }
    }
}
