//! Common parts of the simulators: start states, console, timed events, delayed answers, run options, replay.
//!
//! A family adds the keys of its start state, its console commands, and the controller itself.

pub(crate) mod answers;
pub mod console;
pub mod recording;
pub mod run_options;
pub(crate) mod start;
pub(crate) mod timeline;

/// Declares a struct together with the default values of its fields. A field without `= value` has the default of its
/// type.
macro_rules! with_defaults {
    ($(#[$meta:meta])* $vis:vis struct $name:ident {
        $($(#[$field_meta:meta])* $field_vis:vis $field:ident: $kind:ty $(= $value:expr)?,)*
    }) => {
        $(#[$meta])*
        $vis struct $name {
            $($(#[$field_meta])* $field_vis $field: $kind,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: with_defaults!(value $($value)?),)* }
            }
        }
    };
    (value) => { Default::default() };
    (value $value:expr) => { $value };
}

pub(crate) use with_defaults;
