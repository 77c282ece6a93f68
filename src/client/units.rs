//! Quantities whose type is their unit. The conversion is exact: a value is a whole number of steps of its resolution.
//!
//! ```
//! use armctl_client::units::{Degrees, DegreesPerSecond, Millimetres, MillimetresPerSecond, Percent, Pulses};
//!
//! assert_eq!(Millimetres::from(100).steps(), 100_000);
//! assert_eq!("12.5".parse(), Ok(Millimetres::from_steps(12_500)));
//! assert!("12.0005".parse::<Millimetres>().is_err(), "the resolution is 0.001 mm");
//! assert_eq!(Degrees::from(90).to_string(), "90.0000 deg");
//! assert_eq!(Percent::from(50).short(), "50 %");
//! assert_eq!(MillimetresPerSecond::from_steps(5).to_f64(), 0.5);
//! assert_eq!((Pulses::from(7).steps(), DegreesPerSecond::from(7).steps()), (7, 70));
//! ```

#[doc(inline)]
pub use armctl_controller::units::{
    Degrees, DegreesPerSecond, Millimetres, MillimetresPerSecond, Percent, Pulses, Quantity, Unit, UnitError,
};
