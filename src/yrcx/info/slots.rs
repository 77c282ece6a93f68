//! `yrcx info slots` (4.7.15).

use crate::prelude::*;
use crate::single_command::{format_field, one_row};
use armctl_controller::yrcx::table::Command;

one_row! {
    /// Reads the boards in the option slots.
    #[command(after_help = "The manual defines no number for PROFINET.")]
    Slots(self) "yrcx.info.slots" -> Modules {
        /// Controller, 1 to 4
        #[arg(long, value_name = "N", default_value = "1")]
        controller: String,
    }
    gives Command::Slots,
    with draft => draft.with(Key::Controller, self.controller.as_str()),
    done as answer => {
        let slots = (1..).zip(SLOTS).filter_map(|(slot, key)| {
            let code = format!("0x{:04X}", answer.values.int(key)?);
            Some(Slot { slot, module: format_field(Command::Slots, &answer.values, key)?, code })
        });
        Modules { slots: slots.collect() }
    };
}

const SLOTS: [Key; 4] = [Key::Slot1, Key::Slot2, Key::Slot3, Key::Slot4];

/// Option slots of a controller.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Modules {
    slots: Vec<Slot>,
}

/// An option slot.
#[derive(Debug, Serialize, JsonSchema)]
struct Slot {
    /// Slot number, 1 to 4.
    slot: usize,
    /// Name of the board; `none` if the slot is empty.
    module: String,
    /// Code that the controller reports.
    code: String,
}

impl Report for Modules {
    fn view(&self) -> View {
        let mut table = Table::new(&["slot", "module", "code"], "no slots");
        for Slot { slot, module, code } in &self.slots {
            table.row([(*slot).into(), module.as_str().into(), code.as_str().into()]);
        }
        View::table(table)
    }
}
