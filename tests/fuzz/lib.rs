//! Fuzzing: every parser that reads bytes from outside, as a plain function of bytes ([`TARGETS`]).
//!
//! A target parses its input, formats the result as armctl shows it, and asserts what must hold. The test of each
//! target runs some hundred inputs: its seeds, the crashes of the past, and mutations of both. `guided.rs` runs the
//! same targets under libFuzzer.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

mod links;
mod mutation;
mod seeds;
mod targets;

pub use targets::TARGETS;

/// One entry point for bytes from outside.
#[derive(Debug)]
pub struct Target {
    /// Name, for filters and folders.
    pub name: &'static str,
    /// Parses and formats the input. A panic is a finding.
    pub run: fn(&[u8]),
    /// Valid inputs.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Number of mutations in `cargo test`.
    pub cases: u32,
}

/// Longest input of a mutation.
const MAX_INPUT: usize = 1 << 13;

impl Target {
    /// Finds a target.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// Inputs that once failed: the files of `regressions/NAME/`.
    pub fn regressions(&self) -> Vec<Vec<u8>> {
        files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions").join(self.name))
    }

    /// Seeds and regressions.
    pub fn all_seeds(&self) -> Vec<Vec<u8>> {
        [(self.seeds)(), self.regressions()].concat()
    }

    /// Runs seeds, regressions and mutations. With `ARMCTL_FUZZ_SECONDS`, mutations run for this time, with another
    /// start each time.
    ///
    /// # Panics
    /// The target panics. The message names the file with its input.
    pub fn check(&self) {
        let seeds = self.all_seeds();
        assert!(!seeds.is_empty(), "{} has no seeds", self.name);
        for seed in &seeds {
            self.run_saved(seed);
        }
        let seconds = std::env::var("ARMCTL_FUZZ_SECONDS").ok().and_then(|text| text.parse().ok());
        let until = seconds.map(|seconds| Instant::now() + Duration::from_secs(seconds));
        let mut rng = if until.is_some() { fastrand::Rng::new() } else { fastrand::Rng::with_seed(32) };
        let mut cases = 0;
        while until.map_or(cases < self.cases, |until| Instant::now() < until) {
            self.run_saved(&mutation::mutate(&seeds, &mut rng, MAX_INPUT));
            cases += 1;
        }
    }

    fn run_saved(&self, input: &[u8]) {
        let run = self.run;
        if let Err(panic) = std::panic::catch_unwind(|| run(input)) {
            let file = std::env::temp_dir().join(format!("armctl-fuzz-{}-{}", self.name, std::process::id()));
            let saved = std::fs::write(&file, input);
            eprintln!(
                "{}: {} ({saved:?}); keep it as a file of tests/fuzz/regressions/{0}/",
                self.name,
                file.display()
            );
            std::panic::resume_unwind(panic);
        }
    }
}

/// Contents of the files of a folder, in the order of their names. A folder that does not exist has no files.
fn files(folder: &Path) -> Vec<Vec<u8>> {
    let entries = std::fs::read_dir(folder).into_iter().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("the folder is readable").path()).collect();
    paths.sort();
    paths.iter().filter_map(|path| std::fs::read(path).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_regression_belongs_to_a_target() {
        for entry in std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("regressions")).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            assert!(Target::named(&name).is_some(), "{name} is no target");
        }
    }

    /// Protocols, and the file with their targets.
    const PROTOCOLS: [(&str, &str); 9] = [
        ("controller/toyo", "toyo"),
        ("controller/yerc", "yerc"),
        ("controller/yrcx", "yrcx"),
        ("transport/capture", "files"),
        ("transport/devicenet", "devicenet"),
        ("transport/eip", "eip"),
        ("transport/profibus", "profibus"),
        ("transport/profinet", "profinet"),
        ("transport/session", "peers"),
    ];

    /// Parsers that targets reach through another function.
    const REACHED: [&str; 1] = ["Image::from_bytes"];

    /// A parser: a public function of bytes with such a name.
    const NAMES: [&str; 5] = ["parse", "from_", "read", "walk", "split_list"];

    #[test]
    fn every_parser_of_bytes_has_a_target() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut missing = Vec::new();
        let mut count = 0;
        for (folder, targets) in PROTOCOLS {
            let targets = std::fs::read_to_string(root.join(format!("targets/{targets}.rs"))).unwrap();
            let mut folders = vec![root.join("../../src").join(folder)];
            while let Some(folder) = folders.pop() {
                for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
                    if path.is_dir() {
                        folders.push(path);
                    } else {
                        let parsers = parsers(&std::fs::read_to_string(&path).unwrap());
                        count += parsers.len();
                        let is_missing = |name: &String| !targets.contains(name) && !REACHED.contains(&&**name);
                        missing.extend(parsers.into_iter().filter(is_missing).map(|name| (path.clone(), name)));
                    }
                }
            }
        }
        assert!(count > 60, "only {count} parsers were found");
        assert!(missing.is_empty(), "call these in tests/fuzz/targets/: {missing:#?}");
    }

    /// `Type::name` or `name(` of each public parser of bytes.
    fn parsers(source: &str) -> Vec<String> {
        let mut found = Vec::new();
        let mut kind = "";
        for line in source.lines().take_while(|line| *line != "#[cfg(test)]") {
            if let Some(rest) = line.strip_prefix("impl") {
                let name = rest.rsplit(" for ").next().unwrap_or_default().trim_end_matches(" {");
                let name = name.rsplit('>').find(|part| !part.trim().is_empty()).unwrap_or(name);
                kind = name.split('<').next().unwrap_or_default().trim();
            }
            let Some(rest) = line.trim_start().strip_prefix("pub fn ") else { continue };
            let (arguments, _) = rest.split_once("->").unwrap_or((rest, ""));
            let name = rest.split(['(', '<']).next().unwrap_or_default();
            if arguments.contains("[u8]") && NAMES.iter().any(|start| name.starts_with(start)) {
                let is_method = line.starts_with(' ');
                found.push(if is_method { format!("{kind}::{name}") } else { format!("{name}(") });
            }
        }
        found.retain(|name| !name.contains('$'));
        found
    }

    #[test]
    fn finds_parsers_in_sources() {
        let source = "impl<'a> Frame<'a> {\n    pub fn parse(bytes: &'a [u8]) -> Result<Self, E> {\nimpl Id {\n    \
                      pub fn parse(id: u16) -> X {\n    pub fn emit(&self) -> [u8; 2] {\npub fn walk(bytes: &[u8]) -> X {";
        assert_eq!(parsers(source), ["Frame::parse", "walk("]);
    }
}
