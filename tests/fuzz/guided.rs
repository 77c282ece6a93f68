//! One target under libFuzzer. `ARMCTL_FUZZ_TARGET` names the target, `ARMCTL_FUZZ_CORPUS` the folder that gets its
//! seeds. `tests/fuzz/guided` builds and runs this program.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use armctl_fuzz::Target;

static TARGET: LazyLock<&Target> = LazyLock::new(|| {
    let name = std::env::var("ARMCTL_FUZZ_TARGET").expect("ARMCTL_FUZZ_TARGET names a target");
    Target::named(&name).expect("the target exists")
});

libfuzzer_sys::fuzz_target!(
    init: {
        if let Some(folder) = std::env::var_os("ARMCTL_FUZZ_CORPUS") {
            for (number, seed) in TARGET.all_seeds().iter().enumerate() {
                std::fs::write(PathBuf::from(&folder).join(format!("seed-{number}")), seed).expect("the corpus is a folder");
            }
        }
    },
    |data: &[u8]| (TARGET.run)(data)
);
