//! Texts for failures to open a fieldbus link, for all fieldbuses.

use crate::prelude::basics::*;
use armctl_frame::settings::target::bus::Scheme;
use armctl_transport::image::LinkError;

/// Converts an error of a link or an explicit messaging client that did not open. The scheme comes from the URL.
pub fn not_open(label: &str, Scheme { name, bus, .. }: &Scheme, error: &LinkError) -> Failure {
    let cause = error.cause();
    let options = listed(cause.options);
    let (kind, hint) = match error {
        LinkError::Owned(_) => {
            let message = format!("{label}: another master, such as a PLC, commands the controller: {error}");
            let failure = Failure { code: cause.code.clone(), ..Failure::new(Kind::Refused, message) };
            return failure.hint(cause.advice.as_deref().unwrap_or(OWNED));
        }
        LinkError::Size(_) => {
            (Kind::Malformed, format!("check {options} in the URL; use `yrcx {bus} probe` to find the values"))
        }
        LinkError::Refused(_) => (Kind::Refused, format!("check {options} in the URL; see `armctl help targets`")),
        LinkError::Silent(_) | LinkError::Lost { .. } => {
            (Kind::NoAnswer, "check the link to the controller".to_owned())
        }
        LinkError::Malformed(_) => (Kind::Malformed, "check the address".to_owned()),
        LinkError::Settings(_) => (Kind::Usage, format!("see `armctl help targets` for the options of {name}: URLs")),
        LinkError::Local(_) => (Kind::Local, "check the adapter and its settings on this computer".to_owned()),
    };
    let failure = Failure::new(kind, format!("{label}: {error}")).hint(cause.advice.as_deref().unwrap_or(&hint));
    Failure { code: cause.code.clone(), ..failure }
}

/// Hint if another master owns the device. A fieldbus can replace this hint with its own.
const OWNED: &str = "stop the owner's connection first: remove the controller from the PLC's scan list, or close the \
                     session. `yrcx io get` and `yrcx status` can read the signals at the same time";

/// Lists the options as they are typed in a URL, for example "`in=`, `out=` and `config=`".
fn listed(options: &[&str]) -> String {
    let typed: Vec<String> = options.iter().map(|option| format!("`{option}=`")).collect();
    match &typed[..] {
        [] => "the options".to_owned(),
        [one] => one.clone(),
        [all @ .., last] => format!("{} and {last}", all.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::settings::target;
    use armctl_transport::image::{Cause, Outputs};

    #[test]
    fn link_errors_have_a_hint() {
        let scheme = target::bus::USUAL;
        let cause = || Cause { code: Some("0x0106".to_owned()), ..Cause::new("asked, and refused") };
        let outputs = Outputs::Released;
        for (error, kind, hint) in [
            (LinkError::Owned(cause()), Kind::Refused, "stop the owner's connection first"),
            (LinkError::Owned(cause().advice("ask the PLC")), Kind::Refused, "ask the PLC"),
            (
                LinkError::Size(cause().options(&["in", "in_size"])),
                Kind::Malformed,
                "check `in=` and `in_size=` in the URL",
            ),
            (
                LinkError::Refused(cause().options(&["a", "b", "c"])),
                Kind::Refused,
                "check `a=`, `b=` and `c=` in the URL",
            ),
            (LinkError::Refused(cause().advice("set the ident")), Kind::Refused, "set the ident"),
            (LinkError::Silent(cause()), Kind::NoAnswer, "check the link"),
            (LinkError::Lost { cause: cause(), outputs }, Kind::NoAnswer, "check the link"),
            (LinkError::Malformed(cause()), Kind::Malformed, "check the address"),
            (LinkError::Settings(cause()), Kind::Usage, "for the options of"),
            (LinkError::Local(cause()), Kind::Local, "check the adapter"),
        ] {
            let failure = not_open("cell", &scheme, &error);
            assert_eq!((failure.kind, failure.code.as_deref()), (kind, Some("0x0106")), "{error:?}");
            assert!(
                failure.message.starts_with("cell: ") && failure.message.ends_with("asked, and refused"),
                "{failure}"
            );
            assert!(failure.hint.as_ref().unwrap().contains(hint), "{failure:?}");
        }
    }
}
