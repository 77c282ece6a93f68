//! `yerc move joint|linear|relative` and `yerc move pulse joint|linear` (FS and DX 3.3.39, 3.3.40).

mod arguments;
mod execution;
mod question;
mod variable_target;

pub(super) use self::execution::is_standing;
pub(super) use self::question::{compared, moved_during_question};

use std::borrow::Cow;

use self::arguments::{
    By, Forms, Frame, Mover, Part, Speed, To, Values, base_lengths, base_pulses, robot_pulses, split, station_pulses,
};
use self::execution::{Execution, Goal, MotionReport};
use self::question::Question;
use self::variable_target::Motion;
use crate::number_arguments::parse_in_range;
use crate::prelude::*;
use armctl_controller::units;
use armctl_controller::yerc::payload::{CartesianMove, ExtendedForm, Form, MoveLayout, PulseMove};
use armctl_controller::yerc::query::{Coordinates, MoveCartesian, MoveKind, MovePulse};
use armctl_frame::Subcommands;

commands! {
    /// Motions.
    pub enum Move {
        /// Joint-interpolated move (MOVJ)
        Joint(Joint),
        /// Linear move (MOVL)
        Linear(Linear),
        /// Linear move by a distance (IMOV)
        Relative(Relative),
        /// Move to pulse positions
        Pulse(Subcommands<Pulse>),
    }
}

commands! {
    /// Motions to pulse positions.
    pub enum Pulse {
        /// Joint-interpolated move (MOVJ)
        Joint(PulseJoint),
        /// Linear move (MOVL)
        Linear(PulseLinear),
    }
}

/// Kind of motion, as text for the confirmation.
fn describe_path(kind: MoveKind) -> &'static str {
    match kind {
        MoveKind::Link => "with joint interpolation",
        MoveKind::Straight | MoveKind::Incremental => "in a straight line",
    }
}

/// Cartesian target, with its options.
#[derive(Debug, Args)]
struct Target {
    #[command(flatten)]
    to: To,
    #[command(flatten)]
    frame: Frame,
    #[command(flatten)]
    forms: Forms,
    /// Target of the base axes of the robot, in mm
    #[arg(long, value_name = "MM,…", allow_hyphen_values = true, value_parser = base_lengths)]
    base_axes: Option<Values>,
    /// Target of the station axes, in pulses
    #[arg(long, value_name = "PULSES,…", allow_hyphen_values = true, value_parser = station_pulses)]
    station_axes: Option<Values>,
    #[command(flatten)]
    mover: Mover,
}

impl Target {
    fn question(&self, kind: MoveKind, speed: Speed) -> Question<'_> {
        let Self { to, frame, forms, base_axes, station_axes, mover } = self;
        let robot = to.coordinates();
        let name = to.destination().map(|destination| format!(" to {destination}")).unwrap_or_default();
        Question {
            what: format!("move {} {}{name}", mover.group, describe_path(kind)),
            preposition: "to",
            kind: frame.kind(),
            manner: robot.map(|_| format!("in {}, {}", frame.describe(), forms.describe())).unwrap_or_default(),
            robot: robot.map(Vec::from),
            base: (base_axes.as_ref(), units::MILLIMETRE),
            station: station_axes.as_ref().map(Cow::Borrowed),
            speed,
        }
    }

    /// Moves to the typed coordinates, to the coordinates of a variable, or to joint angles in degrees.
    async fn run(&self, context: Context<'_, Yerc>, kind: MoveKind, speed: Speed) -> Result<MotionReport> {
        match self.to.destination() {
            Some(destination) => Motion { target: self, kind, speed }.run(context, &destination).await,
            None => {
                self.describe_move(context.link, kind, speed).await?.run(context, &self.question(kind, speed)).await
            }
        }
    }

    /// Rejects options whose value is already in the variable or in the pulses.
    fn refuse_extra_flags(&self, flag: &str, has_frame: bool) -> Result<()> {
        let extra_flags = [
            ("--coordinate", self.frame.coordinate.is_some()),
            ("--tool or --user", has_frame),
            ("--form", self.forms.form.is_some() || self.forms.extended_form.is_some()),
            ("--base-axes", self.base_axes.is_some()),
            ("--station-axes", self.station_axes.is_some()),
        ];
        match extra_flags.iter().find(|(_, is_given)| *is_given) {
            None => Ok(()),
            Some((other, _)) => {
                Err(Failure::usage(format!("{other} cannot be used with {flag}, which already defines it"))
                    .hint(format!("remove {other}, or type the target as coordinates")))
            }
        }
    }

    async fn describe_move(&self, link: &mut Link, kind: MoveKind, speed: Speed) -> Result<Execution<MoveCartesian>> {
        let Self { to, frame, forms, base_axes, station_axes, mover } = self;
        let part = split(mover.group, to.coordinates(), "--to", base_axes.as_ref(), station_axes.as_ref())?;
        let coordinate = frame.kind();
        let mut order = cartesian_move(link, mover, speed, frame);
        order.form = forms.form();
        order.extended = forms.extended_form();
        let (goal, unnamed) = match part {
            Part::Robot(target, base) => {
                order.target = target;
                order.base = base.map(Values::with_zeros).unwrap_or_default();
                let goal = match coordinate {
                    PositionKind::Base => Goal::Base(target, frame.tool()),
                    _ => Goal::Unknown(Coordinates::Base),
                };
                (goal, unnamed_base_axes(mover.group, base))
            }
            Part::Station(axes) => {
                order.station_axes = axes.with_zeros();
                (Goal::Pulses(axes.0.clone()), vec![(mover.group, axes.0.len(), "--station-axes")])
            }
        };
        let order = link.by_model(|model| MoveCartesian::new(model, kind, order)).await?;
        Ok(Execution { order, group: mover.group, goal, unnamed, no_wait: mover.end.no_wait() })
    }
}

/// Cartesian move in which the target is not set yet.
fn cartesian_move(link: &Link, mover: &Mover, speed: Speed, frame: &Frame) -> CartesianMove {
    let (robot, station) = mover.words();
    CartesianMove {
        layout: if link.move_words == 25 { MoveLayout::Words25 } else { MoveLayout::Words26 },
        robot,
        station,
        class: speed.class,
        speed: speed.word,
        coordinate: frame.kind(),
        target: [0; 6],
        reserved: [0; 2],
        form: Form::default(),
        extended: ExtendedForm::default(),
        tool: frame.tool(),
        user: frame.user(),
        base: [0; 3],
        station_axes: [0; 6],
    }
}

/// Base of a robot, for the check of axes for which the move has no value. The base has the same number as the robot,
/// and its axes move together with the robot.
fn unnamed_base_axes(group: Group, base: Option<&Values>) -> Vec<(Group, usize, &'static str)> {
    match group {
        Group::Robot(number) => vec![(Group::Base(number), base.map_or(0, |base| base.0.len()), "--base-axes")],
        _ => Vec::new(),
    }
}

macro_rules! motion {
    (
        $(#[$doc:meta])* $name:ident { $(#[$speed_doc:meta])* speed: $parser:expr, $target:ident: $type:ty }, $id:literal,
        |$this:ident, $context:ident| $question:expr, $run:expr
    ) => {
        $(#[$doc])*
        #[derive(Debug, Args)]
        pub struct $name {
            $(#[$speed_doc])*
            #[arg(long, value_parser = $parser)]
            speed: Speed,
            #[command(flatten)]
            $target: $type,
        }

        impl Command for $name {
            type Family = Yerc;
            type Report = MotionReport;
            const ID: &'static str = $id;
            const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

            fn risk(&self) -> Risk {
                Risk::Motion
            }

            fn intent(&self) -> String {
                let $this = self;
                $question.in_a_line()
            }

            async fn run(&self, context: Context<'_, Yerc>) -> Result<MotionReport> {
                let ($this, $context) = (self, context);
                $run.await
            }
        }
    };
}

motion! {
    /// Moves to a position with joint interpolation (0x8A, instance 1).
    Joint {
        /// Speed in percent of the maximum speed, such as 10%
        speed: Speed::percent, target: Target
    }, "yerc.move.joint",
    |this, context| this.target.question(MoveKind::Link, this.speed),
    this.target.run(context, MoveKind::Link, this.speed)
}
motion! {
    /// Moves to a position in a straight line (0x8A, instance 2).
    Linear {
        /// Speed along the path or of the rotation, such as 100mm/s or 20deg/s
        speed: Speed::path, target: Target
    }, "yerc.move.linear",
    |this, context| this.target.question(MoveKind::Straight, this.speed),
    this.target.run(context, MoveKind::Straight, this.speed)
}
motion! {
    /// Moves by a distance in a straight line (0x8A, instance 3).
    Relative {
        /// Speed along the path or of the rotation, such as 100mm/s or 20deg/s
        speed: Speed::path, distance: Distance
    }, "yerc.move.relative",
    |this, context| this.distance.question(this.speed),
    this.distance.describe_move(context.link, this.speed).await?.run(context, &this.distance.question(this.speed))
}
motion! {
    /// Moves to pulses with joint interpolation (0x8B, instance 1).
    PulseJoint {
        /// Speed in percent of the maximum speed, such as 10%
        speed: Speed::percent, target: PulseTarget
    }, "yerc.move.pulse.joint",
    |this, context| this.target.question(MoveKind::Link, this.speed),
    this.target.run(context, MoveKind::Link, this.speed)
}
motion! {
    /// Moves to pulses in a straight line (0x8B, instance 2).
    PulseLinear {
        /// Speed along the path or of the rotation, such as 100mm/s or 20deg/s
        speed: Speed::path, target: PulseTarget
    }, "yerc.move.pulse.linear",
    |this, context| this.target.question(MoveKind::Straight, this.speed),
    this.target.run(context, MoveKind::Straight, this.speed)
}

/// Distance with its options.
#[derive(Debug, Args)]
struct Distance {
    #[command(flatten)]
    by: By,
    #[command(flatten)]
    frame: Frame,
    /// Distances of the base axes of the robot, in mm
    #[arg(long, value_name = "MM,…", allow_hyphen_values = true, value_parser = base_lengths)]
    base_axes: Option<Values>,
    /// Distances of the station axes, in pulses
    #[arg(long, value_name = "PULSES,…", allow_hyphen_values = true, value_parser = station_pulses)]
    station_axes: Option<Values>,
    #[command(flatten)]
    mover: Mover,
}

impl Distance {
    /// Distances of a robot; `None` if only a station moves.
    fn robot(&self) -> Option<[i32; 6]> {
        let by = self.by.distances();
        (self.station_axes.is_none() || by != [0; 6]).then_some(by)
    }

    fn question(&self, speed: Speed) -> Question<'_> {
        let Self { frame, base_axes, station_axes, mover, .. } = self;
        let robot = self.robot();
        Question {
            what: format!("move {} {}", mover.group, describe_path(MoveKind::Incremental)),
            preposition: "by",
            kind: frame.kind(),
            manner: robot.map(|_| format!("in {}", frame.describe())).unwrap_or_default(),
            robot: robot.map(Vec::from),
            base: (base_axes.as_ref(), units::MILLIMETRE),
            station: station_axes.as_ref().map(Cow::Borrowed),
            speed,
        }
    }

    async fn describe_move(&self, link: &mut Link, speed: Speed) -> Result<Execution<MoveCartesian>> {
        let Self { frame, base_axes, station_axes, mover, .. } = self;
        let mut order = cartesian_move(link, mover, speed, frame);
        let goal = match split(mover.group, self.robot(), "--by", base_axes.as_ref(), station_axes.as_ref())? {
            Part::Robot(by, base) => {
                order.target = by;
                order.base = base.map(Values::with_zeros).unwrap_or_default();
                match (frame.kind(), by, base) {
                    (PositionKind::Base, [x, y, z, 0, 0, 0], None) => Goal::Relative([x, y, z], frame.tool()),
                    _ => Goal::Unknown(Coordinates::Base),
                }
            }
            Part::Station(axes) => {
                order.station_axes = axes.with_zeros();
                Goal::Unknown(Coordinates::Pulse)
            }
        };
        if order.target == [0; 6] && order.base == [0; 3] && order.station_axes == [0; 6] {
            return Err(Failure::usage("all distances are 0, so no axis would move")
                .hint("type at least one of --x --y --z --rx --ry --rz, or --by"));
        }
        let order = link.by_model(|model| MoveCartesian::new(model, MoveKind::Incremental, order)).await?;
        Ok(Execution { order, group: mover.group, goal, unnamed: Vec::new(), no_wait: mover.end.no_wait() })
    }
}

/// Target in pulses with its options.
#[derive(Debug, Args)]
struct PulseTarget {
    /// Target in pulses, of six axes, or of seven or eight axes if the robot has them
    #[arg(long, value_name = "S,L,U,R,B,T[,7[,8]]", allow_hyphen_values = true, value_parser = robot_pulses,
        required_unless_present = "station_axes")]
    pulses: Option<Values>,
    /// Tool number
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_in_range::<u32>(0, 63))]
    tool: u32,
    /// Target of the base axes of the robot, in pulses
    #[arg(long, value_name = "PULSES,…", allow_hyphen_values = true, value_parser = base_pulses)]
    base_axes: Option<Values>,
    /// Target of the station axes, in pulses
    #[arg(long, value_name = "PULSES,…", allow_hyphen_values = true, value_parser = station_pulses)]
    station_axes: Option<Values>,
    #[command(flatten)]
    mover: Mover,
}

impl PulseTarget {
    fn question(&self, kind: MoveKind, speed: Speed) -> Question<'_> {
        let Self { pulses, tool, base_axes, station_axes, mover } = self;
        Question {
            what: format!("move {} {}", mover.group, describe_path(kind)),
            preposition: "to",
            kind: PositionKind::Pulse,
            manner: format!("in pulses, tool {tool},"),
            robot: pulses.as_ref().map(|pulses| pulses.0.clone()),
            base: (base_axes.as_ref(), units::PULSE),
            station: station_axes.as_ref().map(Cow::Borrowed),
            speed,
        }
    }

    async fn run(&self, context: Context<'_, Yerc>, kind: MoveKind, speed: Speed) -> Result<MotionReport> {
        self.describe_move(context.link, kind, speed).await?.run(context, &self.question(kind, speed)).await
    }

    async fn describe_move(&self, link: &mut Link, kind: MoveKind, speed: Speed) -> Result<Execution<MovePulse>> {
        let Self { pulses, tool, base_axes, station_axes, mover } = self;
        let part = split(mover.group, pulses.as_ref(), "--pulses", base_axes.as_ref(), station_axes.as_ref())?;
        let (robot, station) = mover.words();
        let mut order = PulseMove {
            robot,
            station,
            class: speed.class,
            speed: speed.word,
            axes: [0; 8],
            tool: *tool,
            base: [0; 3],
            station_axes: [0; 6],
        };
        let (target, unnamed) = match part {
            Part::Robot(axes, base) => {
                order.axes = axes.with_zeros();
                order.base = base.map(Values::with_zeros).unwrap_or_default();
                let mut unnamed_axes = unnamed_base_axes(mover.group, base);
                unnamed_axes.push((mover.group, axes.0.len(), "--pulses"));
                (axes, unnamed_axes)
            }
            Part::Station(axes) => {
                order.station_axes = axes.with_zeros();
                (axes, vec![(mover.group, axes.0.len(), "--station-axes")])
            }
        };
        let order = link.by_model(|model| MovePulse::new(model, kind, order)).await?;
        let goal = Goal::Pulses(target.0.clone());
        Ok(Execution { order, group: mover.group, goal, unnamed, no_wait: mover.end.no_wait() })
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{DX200, error_text, frames, frames_on, golden, intent, reports};
    use armctl_frame::failure::Kind;

    /// Head of a frame, and the words in its data.
    fn words(frame: &str) -> (&str, Vec<i32>) {
        let bytes: Vec<u8> =
            (16..frame.len()).step_by(2).map(|at| u8::from_str_radix(&frame[at..at + 2], 16).unwrap()).collect();
        let words = bytes.chunks_exact(4).map(|word| i32::from_le_bytes(word.try_into().unwrap()));
        (&frame[..16], words.collect())
    }

    /// The move request in the frames of a dry run. There must be exactly one.
    fn order_on(target: &str, line: &str) -> String {
        let sent = frames_on(target, line).unwrap();
        let orders: Vec<&String> =
            sent.iter().filter(|frame| frame.starts_with("8a") || frame.starts_with("8b")).collect();
        let [order] = orders[..] else { panic!("{line}: {sent:?}") };
        order.clone()
    }

    fn order(line: &str) -> String {
        order_on(DX200, line)
    }

    #[test]
    fn dry_run_shows_reads_before_and_after() {
        let heads = |line: &str| frames(line).unwrap().iter().map(|frame| frame[..8].to_owned()).collect::<Vec<_>>();
        // Expected reads: position and axes of the base, position and axes of the robot. Then the move request and the
        // status reads.
        let before = ["75000b00", "74000b00", "75006500", "74006500"];
        let after = ["72000100", "75006500", "70000100"];
        assert_eq!(heads(FAR), [&before[..], &["8a000200"], &after].concat());
        assert_eq!(heads(&format!("{FAR} --no-wait")), [&before[..2], &["8a000200"]].concat());
    }

    #[test]
    fn linear_move_is_the_golden_frame() {
        for line in [
            "move linear --to 185,0,125,180,0,0 --speed 70mm/s --tool 1",
            "move linear --x 185.000 --y 0 --z 125 --rx 180 --ry -0 --rz 0 --speed 70.0mm/s --tool 1 --no-wait",
        ] {
            assert_eq!(order(line), golden("R75"), "{line}");
        }
    }

    #[test]
    fn pulse_move_is_the_golden_frame() {
        assert_eq!(order("move pulse joint --pulses 0,0,0,0,-90000,0 --speed 10%"), golden("R77"));
    }

    #[test]
    fn places_every_word_of_a_cartesian_move() {
        let line = "move joint --group R2 --to -1,2,-3,4,-5,6 --speed 50% --coordinate user --user 7 --tool 8 \
                    --form back,lower,noflip,s-ge180 --extended-form w-ge180 --base-axes 1.5,-2";
        let expected =
            [2, 0, 0, 5000, 18, -1000, 2000, -3000, 40_000, -50_000, 60_000, 0, 0, 0b10_0111, 0b1_0000, 8, 7];
        let axes = [1500, -2000, 0, 0, 0, 0, 0, 0, 0];
        let sent = order(line);
        assert_eq!(words(&sent), ("8a00010001020000", [&expected[..], &axes[..]].concat()));
        // FS 3.3.39 prints one reserved word less.
        let sent = order_on("udp://h?model=fs100&move_words=25", line);
        assert_eq!(words(&sent).1, [&expected[..11], &expected[12..], &axes[..]].concat());
    }

    #[test]
    fn missing_distances_are_zero_but_one_is_required() {
        let sent = order("move relative --z -50 --rz 0.5 --speed 20deg/s --coordinate tool");
        let (head, data) = words(&sent);
        assert_eq!(head, "8a00030001020000");
        assert_eq!(data[..11], [1, 0, 2, 200, 19, 0, 0, -50_000, 0, 0, 5000]);
        assert_eq!(order("move relative --by 0,0,-50,0,0,0.5 --speed 20deg/s --coordinate tool"), sent);
        for nothing in ["--x 0", "--by 0,0,0,0,0,0", "--base-axes 0"] {
            let failure = frames(&format!("move relative {nothing} --speed 1mm/s")).unwrap_err();
            assert_eq!((failure.kind, &failure.message[..19]), (Kind::Usage, "all distances are 0"));
        }
        assert!(error_text("move relative --speed 1mm/s").contains("--by"));
    }

    #[test]
    fn station_moves_by_its_own_axes() {
        let sent = order("move pulse joint --group S2 --station-axes 100,-200 --speed 5%");
        let (_, data) = words(&sent);
        assert_eq!(data[..4], [0, 2, 0, 500]);
        assert_eq!(data[4..16], [0; 12]);
        assert_eq!(data[16..], [100, -200, 0, 0, 0, 0]);
        for wrong in [
            "move joint --group S1 --to 1,2,3,4,5,6 --speed 1%",
            "move joint --group R1 --station-axes 5 --speed 1%",
            "move joint --to 1,2,3,4,5,6 --station-axes 5 --speed 1%",
            "move pulse linear --group S1 --station-axes 1 --base-axes 1 --speed 1mm/s",
            "move relative --group S1 --x 5 --speed 1mm/s",
        ] {
            assert_eq!(frames(wrong).unwrap_err().kind, Kind::Usage, "{wrong}");
        }
    }

    #[test]
    fn requires_every_coordinate() {
        let missing = error_text("move linear --x 1 --y 2 --z 3 --rx 4 --ry 5 --speed 1mm/s");
        assert!(missing.contains("provided:\n  --rz <DEG>\n"), "{missing}");
        assert!(error_text("move linear --to 1,2,3 --speed 1mm/s").contains("six numbers"));
        assert!(error_text("move linear --to 1,2,3,4,5,6 --x 1 --speed 1mm/s").contains("cannot be used with"));
        assert!(error_text("move linear --to 1,2,3,4,5,6").contains("--speed"));
        assert!(error_text("move pulse joint --pulses 1,2,3,4,5 --speed 1%").contains("6 to 8"));
        assert!(error_text("move joint --to 1,2,3,4,5,6 --speed 1% --coordinate user").contains("--user"));
    }

    #[test]
    fn checks_speed_and_group_of_a_motion() {
        assert!(error_text("move joint --to 1,2,3,4,5,6 --speed 10mm/s").contains("percent"));
        assert!(error_text("move linear --to 1,2,3,4,5,6 --speed 10%").contains("mm/s or deg/s"));
        assert!(error_text("move joint --to 1,2,3,4,5,6 --speed 1% --group B1").contains("--base-axes"));
        let failure =
            frames_on("udp://h?model=fs100", "move joint --to 1,2,3,4,5,6 --speed 1% --group R3").unwrap_err();
        assert!(failure.message.contains("robot number is 3; allowed: 1 to 2"), "{failure}");
    }

    #[test]
    fn question_names_target_and_speed() {
        assert_eq!(
            intent("move linear --to 185,0,125,180,0,0 --speed 70mm/s --tool 1 --form noflip"),
            "move R1 in a straight line to x=185.000 y=0.000 z=125.000 mm, rx=180.0000 ry=0.0000 rz=0.0000 deg in base \
             coordinates, tool 1, form front+upper+noflip at 70.0 mm/s"
        );
        assert_eq!(
            intent("move pulse joint --pulses 0,0,0,0,-90000,0 --speed 10%"),
            "move R1 with joint interpolation to s=0 l=0 u=0 r=0 b=-90000 t=0 in pulses, tool 0, at 10.00 %"
        );
        assert_eq!(
            intent("move relative --z -5 --speed 1mm/s --base-axes 1"),
            "move R1 in a straight line by x=0.000 y=0.000 z=-5.000 mm, rx=0.0000 ry=0.0000 rz=0.0000 deg, base 1.000 mm \
             in base coordinates, tool 0 at 1.0 mm/s"
        );
    }

    const FAR: &str = "move linear --to 1300,0,1200,180,0,0 --speed 100mm/s";

    #[tokio::test(start_paused = true)]
    async fn waits_for_the_end_of_a_motion() {
        let lines =
            [FAR, FAR, "move relative --z -50 --speed 100mm/s --coordinate tool", "position --coordinates base"];
        let [far, again, up, position] = reports("", &lines).await.try_into().unwrap();
        let (far, again, up, position) = (far.unwrap(), again.unwrap(), up.unwrap(), position.unwrap());
        assert_eq!((&far["reached"], &far["position"]["x_mm"]), (&json!(true), &json!(1300.0)));
        let elapsed = far["elapsed_ms"].as_u64().unwrap();
        assert!((3000..3500).contains(&elapsed), "300 mm at 100 mm/s take {elapsed} ms");
        assert!(again["elapsed_ms"].as_u64().unwrap() < 200, "the robot is there already: {again}");
        assert_eq!(up["reached"], json!(null), "base coordinates are not conclusive");
        let position = &position["positions"][0];
        assert_eq!(position["text"], up["position"]["text"]);
        assert_ne!(position["z_mm"], json!(1200.0));
    }

    #[tokio::test(start_paused = true)]
    async fn no_wait_leaves_the_motion_running() {
        let [moved, status] = reports("", &[&format!("{FAR} --no-wait"), "status"]).await.try_into().unwrap();
        assert_eq!(moved.unwrap()["elapsed_ms"], json!(null));
        assert_eq!(status.unwrap()["running"], json!(true));
    }

    #[tokio::test(start_paused = true)]
    async fn alarm_or_hold_fails_with_the_position() {
        for (event, told) in [("alarm 4315 3 1", "alarm 4315 "), ("hold external on", "hold by external signal")] {
            let state = format!("[[event]]\nat_ms = 1000\ndo = \"{event}\"\n");
            let [moved, position] = reports(&state, &[FAR, "position"]).await.try_into().unwrap();
            let failure = moved.unwrap_err();
            assert_eq!(failure.kind, Kind::ConditionNotMet);
            assert!(failure.message.contains(told), "{failure}");
            let x_mm = position.unwrap()["positions"][1]["x_mm"].as_f64().unwrap();
            assert!((1001.0..1299.0).contains(&x_mm), "{x_mm}");
            assert!(failure.message.contains(&format!("position: x={x_mm:.3} ")), "{failure}");
        }
    }

    #[tokio::test(start_paused = true)]
    async fn axis_without_a_target_does_not_move_to_zero() {
        let state = "positions = { B1 = [5000], S1 = [0, 70] }";
        let lines =
            [FAR, "move joint --group S1 --station-axes 5 --speed 1%", "position --group B1", "position --group S1"];
        let [far, station, base, still] = reports(state, &lines).await.try_into().unwrap();
        let failure = far.unwrap_err();
        assert_eq!(failure.kind, Kind::Usage);
        assert_eq!(failure.message, "axis 1 of B1 is at 5000 pulses and has no target, so it would move to 0");
        assert!(station.unwrap_err().message.starts_with("axis 2 of S1 is at 70 pulses"));
        assert_eq!(base.unwrap()["positions"][0]["text"], "pulse:1=5000");
        assert_eq!(still.unwrap()["positions"][0]["text"], "pulse:1=0,2=70");
    }
}
