//! Two network namespaces that are connected by virtual network cards. The first has the card `pc0` with 192.168.79.1
//! and 02:00:00:00:00:01, and the second has the card `pd0` with 192.168.79.2 and 02:00:00:00:00:02. The tests need
//! user namespaces, but no privileges.

use std::process::{Command, Stdio};

/// Message of a test that is skipped because there are no user namespaces.
pub const SKIPPED: &str = "skipped: there are no user namespaces here";

/// Functions for scripts. `wait_for TEXT FILE PID` waits until a file contains a text. It ends the script when the process
/// that writes the file has ended. The file can appear later, because a shell starts background commands in a process of
/// their own, which creates the file.
const FUNCTIONS: &str = r#"
wait_for() { until grep -qs -e "$1" "$2"; do kill -0 "$3" || exit 1; done; }
"#;

/// Creates both namespaces, and runs `$INSIDE` in the first namespace. `$THERE COMMAND` runs a command in the second
/// namespace.
const SCRIPT: &str = r#"
set -e
mount -t sysfs none /sys
ip link set lo up
ip link add pc0 type veth peer name pd0
unshare -nm sh -c 'mount -t sysfs none /sys; exec sleep 3600' & P=$!
until [ "$(readlink /proc/$P/ns/net)" != "$(readlink /proc/self/ns/net)" ] && grep -q sleep /proc/$P/cmdline; do :; done
ip link set pc0 address 02:00:00:00:00:01
ip link set pd0 address 02:00:00:00:00:02
ip link set pd0 netns $P
ip addr add 192.168.79.1/24 dev pc0
ip link set pc0 up
export THERE="nsenter -t $P -n -m"
$THERE sh -c 'ip link set lo up; ip addr add 192.168.79.2/24 dev pd0; ip link set pd0 up'
R=0
sh -c "$INSIDE" || R=$?
kill $P
exit $R
"#;

/// Runs shell commands in the first namespace, with these variables. Returns their output; `None` without user
/// namespaces.
pub fn run(inside: &str, variables: &[(&str, &str)]) -> Option<String> {
    let can = Command::new("unshare").args(["-Urnm", "true"]).stderr(Stdio::null()).status();
    if !can.is_ok_and(|status| status.success()) {
        return None;
    }
    let mut command = Command::new("unshare");
    command
        .args(["-Urnm", "sh", "-c", SCRIPT])
        .env("INSIDE", format!("{FUNCTIONS}{inside}"))
        .envs(variables.iter().copied());
    let output = command.output().expect("unshare can be started");
    Some(format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr)))
}
