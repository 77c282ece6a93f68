//! Candidate layouts for a device without a GSDML file.

use super::error::ModuleMismatch;
use super::layout::{Layout, Submodule};
use super::wire::record::RealModule;

/// Maximum number of candidates.
const MAX_CANDIDATES: usize = 8;

/// Returns candidate layouts for images of `size` bytes, the likeliest first. A device reports its real modules, but
/// neither the direction nor the size of their data. Therefore the candidates are combinations of these modules.
pub fn layouts(real: &[RealModule], size: u16) -> Vec<Layout> {
    let all = real.iter().flat_map(|module| module.submodules.iter().map(move |submodule| (module, *submodule)));
    let bare: Vec<Submodule> = all
        .map(|(module, (subslot, ident))| Submodule {
            slot: module.slot,
            subslot,
            module: module.ident,
            ident,
            input: 0,
            output: 0,
        })
        .collect();
    // These positions can have data. Slot 0 is the access point, and interfaces and ports have no data.
    let places: Vec<usize> =
        (0..bare.len()).filter(|at| bare[*at].slot != 0 && bare[*at].subslot < FIRST_PORT).collect();
    let mut layouts = Vec::new();
    let mut add = |input: usize, output: usize| {
        let mut submodules = bare.clone();
        submodules[input].input = size;
        submodules[output].output = size;
        layouts.extend(Layout::new(submodules).ok().filter(|_| layouts.len() < MAX_CANDIDATES));
    };
    for (at, first) in places.iter().enumerate() {
        for second in &places[at + 1..] {
            add(*first, *second);
            add(*second, *first);
        }
    }
    for only in &places {
        add(*only, *only);
    }
    layouts
}

/// First subslot of interfaces and ports.
const FIRST_PORT: u16 = 0x8000;

/// Corrects a layout with the differences that the device reported. Modules that the device does not have are removed.
/// Returns `None` if the layout does not change.
pub fn with_reported_modules(layout: &Layout, mismatches: &[ModuleMismatch]) -> Option<Layout> {
    let fitted = layout.0.iter().filter_map(|submodule| {
        let mut submodule = *submodule;
        for mismatch in mismatches.iter().filter(|mismatch| mismatch.slot == submodule.slot) {
            match mismatch.subslot {
                None => submodule.module = mismatch.found?,
                Some(subslot) if subslot == submodule.subslot => submodule.ident = mismatch.found?,
                Some(_) => {}
            }
        }
        Some(submodule)
    });
    Layout::new(fitted.collect()).ok().filter(|fitted| fitted != layout)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn module(slot: u16, ident: u32, submodules: &[(u16, u32)]) -> RealModule {
        RealModule { slot, ident, submodules: submodules.to_vec() }
    }

    fn texts(real: &[RealModule]) -> Vec<String> {
        layouts(real, 48).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn tries_modules_in_both_orders() {
        let head = module(0, 1, &[(1, 1), (0x8000, 0x8000)]);
        let two = [head.clone(), module(1, 0x101, &[(1, 1)]), module(2, 0x102, &[(1, 7), (0x8001, 9)])];
        let before = "0:0x1,0.0x8000:0x1/0x8000";
        let port = "2.0x8001:0x102/0x9";
        assert_eq!(
            texts(&two)[..3],
            [
                format!("{before},1:0x101:i48,2:0x102/0x7:o48,{port}"),
                format!("{before},1:0x101:o48,2:0x102/0x7:i48,{port}"),
                format!("{before},1:0x101:i48o48,2:0x102/0x7,{port}"),
            ]
        );
        assert_eq!(texts(&[head.clone(), module(3, 5, &[(1, 1)])]), [format!("{before},3:0x5:i48o48")]);
        assert_eq!(texts(&[head]), Vec::<String>::new());
        let many: Vec<RealModule> = (1..40).map(|slot| module(slot, 1, &[(1, 1)])).collect();
        assert_eq!(texts(&many).len(), MAX_CANDIDATES);
    }

    #[test]
    fn uses_the_modules_that_a_device_reports() {
        let layout: Layout = "0:1,1:0x99:i48,2:0x102:o48,3:4".parse().unwrap();
        let mismatch = |slot, subslot, found| ModuleMismatch { slot, subslot, found, expected: None };
        let told = [mismatch(1, None, Some(0x40)), mismatch(2, Some(1), Some(5)), mismatch(3, None, None)];
        assert_eq!(with_reported_modules(&layout, &told).unwrap().to_string(), "0:0x1,1:0x40:i48,2:0x102/0x5:o48");
        assert_eq!(with_reported_modules(&layout, &[mismatch(1, None, Some(0x99))]), None, "nothing new");
    }
}
