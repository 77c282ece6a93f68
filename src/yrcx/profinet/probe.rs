//! `yrcx profinet probe`.

use std::collections::VecDeque;

use super::board::Board;
use super::station::Station;
use super::{connect, plan_search};
use crate::prelude::*;
use armctl_transport::profinet::candidate_layouts;
use armctl_transport::profinet::commission::Identity;
use armctl_transport::profinet::error::ProfinetError;
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::wire::record::{Im0, RealModule};

/// Reads the records of the station (I&M0, 0xF000): identity and modules. armctl opens no connection for this.
#[derive(Debug, Args)]
#[command(
    after_help = "With --try, armctl connects with the layout of the target, then with the layouts that its modules \
                  allow, until data flows. Each connection sends the resting image to the controller. The end of each \
                  connection stops the robot. If another controller owns the station, the station refuses the \
                  connection, and nothing changes."
)]
pub struct Probe {
    /// Connect with one layout after the other until one fits
    #[arg(long = "try")]
    tries: bool,
}

impl Command for Probe {
    type Family = Yrcx;
    type Report = ProbeReport;
    const ID: &'static str = "yrcx.profinet.probe";
    const INTENT: &'static str =
        "connect to the station with one layout after the other (the end of each connection stops the robot)";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    fn risk(&self) -> Risk {
        // With --try, the command starts no motion, but the end of a connection stops the robot.
        if self.tries { Risk::Motion } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<ProbeReport> {
        let Context { robot, link, .. } = context;
        link.reject_unit_of::<Board>()?;
        link.then("calls that read I&M0 and the modules (ReadImplicit of 0xAFF0 and 0xF000)");
        if self.tries {
            link.then("a connection with each possible layout, until data flows");
        }
        plan_search(link, robot)?;
        if self.tries {
            link.authorize(Self::ID, self.risk())?;
        }
        let board: &Board = link.board()?;
        let found = board.station().await?;
        let station = Station::from(&found);
        let identity = board.identity(found).await?;
        let guesses = possible(board, &identity);
        let tried = if self.tries { attempts(board, guesses.into()).await? } else { untried(&guesses) };
        Ok(ProbeReport::new(station, identity, tried, self.tries))
    }
}

/// Returns the layouts that are possible. The layout of the target comes first.
fn possible(board: &Board, identity: &Identity) -> Vec<Layout> {
    let bytes = u16::try_from(Image::BYTES).unwrap_or(u16::MAX);
    // An error is ignored, because this command is also for targets without a layout.
    let told = connect::settings(&board.profinet, Duration::ZERO).ok().map(|settings| settings.layout);
    let guessed = match &identity.modules {
        Ok(real) => candidate_layouts::layouts(real, bytes),
        // Start with any layout: the answer of the device lists its real modules.
        Err(_) => vec![Layout::two_modules(1, 2)],
    };
    let mut layouts: Vec<Layout> = Vec::new();
    for layout in told.into_iter().chain(guessed) {
        if !layouts.contains(&layout) {
            layouts.push(layout);
        }
    }
    layouts
}

/// Maximum number of connection attempts.
const MAX_ATTEMPTS: usize = 10;

async fn attempts(board: &Board, mut left: VecDeque<Layout>) -> Result<Vec<Attempt>> {
    let mut tried: Vec<(Layout, Attempt)> = Vec::new();
    while let Some(layout) = left.pop_front().filter(|_| tried.len() < MAX_ATTEMPTS) {
        if tried.iter().any(|(other, _)| *other == layout) {
            continue;
        }
        let answer = board.attempt(&layout).await?;
        if let Err(ProfinetError::Modules(mismatches)) = &answer {
            left.extend(candidate_layouts::with_reported_modules(&layout, mismatches));
        }
        let is_over = match &answer {
            Err(ProfinetError::Refused { status, .. }) => status.is_owned(),
            // Another attempt is of no use after a success, without a device, or with a problem of this computer.
            Ok(()) | Err(ProfinetError::NotFound { .. } | ProfinetError::Privilege | ProfinetError::PortTaken(_)) => {
                true
            }
            Err(_) => false,
        };
        let text = answer.as_ref().map_or_else(ToString::to_string, |()| "data flows both ways".to_owned());
        let attempt = Attempt { layout: layout.to_string(), fits: Some(answer.is_ok()), answer: Some(text) };
        tried.push((layout, attempt));
        if is_over {
            break;
        }
    }
    Ok(tried.into_iter().map(|(_, attempt)| attempt).collect())
}

fn untried(layouts: &[Layout]) -> Vec<Attempt> {
    layouts.iter().map(|layout| Attempt { layout: layout.to_string(), fits: None, answer: None }).collect()
}

/// Result of the probe.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeReport {
    #[serde(flatten)]
    station: Station,
    /// Identity record I&M0; null if the station does not report it.
    identity: Option<Product>,
    /// Modules in the slots of the station; null if the station does not report them.
    modules: Option<Vec<Module>>,
    /// Reasons why data is missing.
    refusals: Vec<String>,
    /// Layouts that are possible or were tried, in the form of `layout=` of a target.
    layouts: Vec<Attempt>,
    #[serde(skip)]
    has_tried: bool,
}

/// Identity record I&M0. Do not trust its texts.
#[derive(Debug, Serialize, JsonSchema)]
struct Product {
    order_id: String,
    serial: String,
    /// Vendor id of the manufacturer, for example `0x0123`.
    maker: String,
    hardware: u16,
    /// Software version, for example `V1.2.3`.
    software: String,
}

/// A module in a slot of the station.
#[derive(Debug, Serialize, JsonSchema)]
struct Module {
    slot: u16,
    /// Ident number, for example `0x101`.
    ident: String,
    /// Subslots with the ident numbers of their submodules, for example `0x1:0x1`.
    submodules: Vec<String>,
}

/// A layout, and the result of a connection attempt with it.
#[derive(Debug, Serialize, JsonSchema)]
struct Attempt {
    /// Layout, for example `0:0x1,1:0x101:i48,2:0x102:o48`.
    layout: String,
    /// Whether the station accepts the layout; null if not tried.
    fits: Option<bool>,
    /// Answer of the station; null if not tried.
    answer: Option<String>,
}

impl From<Im0> for Product {
    fn from(im0: Im0) -> Self {
        let (released, major, minor, patch) = im0.software;
        Self {
            order_id: im0.order_id,
            serial: im0.serial,
            maker: format!("{:#06x}", im0.vendor),
            hardware: im0.hardware,
            software: format!("{released}{major}.{minor}.{patch}"),
        }
    }
}

impl From<RealModule> for Module {
    fn from(module: RealModule) -> Self {
        let shown = |(subslot, ident): &(u16, u32)| format!("{subslot:#x}:{ident:#x}");
        Self {
            slot: module.slot,
            ident: format!("{:#x}", module.ident),
            submodules: module.submodules.iter().map(shown).collect(),
        }
    }
}

impl ProbeReport {
    fn new(station: Station, identity: Identity, layouts: Vec<Attempt>, has_tried: bool) -> Self {
        let mut refusals = Vec::new();
        let mut refused = |error: &ProfinetError| refusals.push(error.to_string());
        let product = identity.im0.inspect_err(&mut refused).ok().map(Product::from);
        let modules = identity.modules.inspect_err(&mut refused).ok();
        let modules = modules.map(|modules| modules.into_iter().map(Module::from).collect());
        Self { station, identity: product, modules, refusals, layouts, has_tried }
    }
}

impl Report for ProbeReport {
    const ROWS: RowsOf = RowsOf::List("modules");

    fn view(&self) -> View {
        let mut fields = self.station.fields();
        if let Some(product) = &self.identity {
            fields.extend([
                ("order id", Cell::from(product.order_id.as_str())),
                ("serial", product.serial.as_str().into()),
                ("maker", product.maker.as_str().into()),
                ("hardware", product.hardware.to_string().into()),
                ("software", product.software.as_str().into()),
            ]);
        }
        fields.extend(self.refusals.iter().map(|why| ("remark", Cell::from(why.as_str()).tone(Tone::Warning))));
        let mut view = View::default().append(Section::Fields(fields));
        if let Some(modules) = &self.modules {
            let mut table = Table::new(&["slot", "module", "submodules"], "no modules");
            for module in modules {
                table.row([module.slot.into(), module.ident.as_str().into(), module.submodules.join(" ").into()]);
            }
            view = view.append(Section::Table(table));
        }
        let mut table = Table::new(&["possible layout", "answer"], "no possible layout");
        for attempt in &self.layouts {
            let answer = Cell::optional(attempt.answer.as_deref());
            let tone = match attempt.fits {
                Some(true) => Tone::Good,
                Some(false) => Tone::Bad,
                None => Tone::Plain,
            };
            table.row([Cell::from(attempt.layout.as_str()).whole(), answer.tone(tone)]);
        }
        view.append(Section::Table(table))
    }

    fn failure(&self) -> Option<Failure> {
        let is_open = self.has_tried && !self.layouts.iter().any(|attempt| attempt.fits == Some(true));
        is_open.then(|| {
            Failure::new(Kind::ConditionNotMet, "none of the tried layouts fits")
                .hint("get the GSDML file of the unit and read it with `armctl yrcx profinet gsdml FILE`")
        })
    }
}
