//! Build information for `armctl --version`. The same sources yield the same binary on every day: the date is
//! SOURCE_DATE_EPOCH, or that of the commit.

use std::path::Path;
use std::process::Command;

const UNKNOWN: &str = "unknown";

fn main() {
    let is_release = std::env::var("PROFILE").is_ok_and(|profile| profile == "release");
    let commit = if is_release { commit() } else { None };
    let date = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|seconds| date(seconds.trim().parse().ok()?));
    let (hash, day) = commit.unzip();
    // Otherwise a development build would be repeated after every commit.
    let missing = if is_release { UNKNOWN } else { "not recorded in a development build" };
    // Not ARMCTL_…: cargo also sets these for the programs that it runs, and armctl reads ARMCTL_TARGET as a target.
    println!("cargo::rustc-env=BUILT_COMMIT={}", hash.as_deref().unwrap_or(missing));
    println!("cargo::rustc-env=BUILT_DATE={}", date.or(day).as_deref().unwrap_or(missing));
    println!("cargo::rustc-env=BUILT_TARGET={}", std::env::var("TARGET").as_deref().unwrap_or(UNKNOWN));
    println!("cargo::rerun-if-env-changed=SOURCE_DATE_EPOCH");
    println!("cargo::rerun-if-changed=build.rs");
}

/// Hash and date of the commit, if these sources are a checkout, and not only inside of one, such as an unpacked
/// archive.
fn commit() -> Option<(String, String)> {
    if !Path::new(".git").exists() {
        return None;
    }
    // Uncommitted changes are part of the hash, and every commit or checkout is a line of this log.
    let log = git(&["rev-parse", "--git-path", "logs/HEAD"])?;
    for path in ["src", "Cargo.toml", "Cargo.lock", &log].into_iter().filter(|path| Path::new(path).exists()) {
        println!("cargo::rerun-if-changed={path}");
    }
    Some((git(&["describe", "--always", "--dirty", "--exclude=*"])?, git(&["log", "-1", "--format=%cs"])?))
}

fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}

/// Day (UTC) of a time in seconds since 1970.
fn date(seconds: i64) -> Option<String> {
    let is_leap = |year: i64| year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let mut day = u32::try_from(seconds.div_euclid(86_400)).ok()?;
    let mut year = 1970;
    while day >= 365 + u32::from(is_leap(year)) {
        day -= 365 + u32::from(is_leap(year));
        year += 1;
    }
    let february = 28 + u32::from(is_leap(year));
    let mut month = 1;
    for days in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31] {
        if day < days {
            break;
        }
        day -= days;
        month += 1;
    }
    Some(format!("{year}-{month:02}-{:02}", day + 1))
}
