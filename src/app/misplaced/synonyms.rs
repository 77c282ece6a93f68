//! Other words for commands, and words in another order, as people type them.

/// What is typed, without the family, and the commands that do it.
#[rustfmt::skip]
pub const LINES: &[(&str, &[&str])] = &[
    ("add", &["robots add"]),
    ("alarm", &["yerc alarm list", "yrcx alarm list", "toyo alarm list"]),
    ("config", &["robots list"]),
    ("connect", &["repl", "session open"]),
    ("delete", &["yerc file delete", "toyo program delete"]),
    ("dir", &["yerc file list", "toyo program list"]),
    ("download", &["yerc file get", "toyo program get", "yrcx backup"]),
    ("error", &["yerc alarm list", "yrcx alarm list", "toyo alarm list"]),
    ("errors", &["yerc alarm history", "yrcx alarm history", "toyo alarm history"]),
    ("estop", &["yerc hold on", "yrcx emergency-stop", "toyo stop"]),
    ("fault", &["yerc alarm list", "yrcx alarm list", "toyo alarm list"]),
    ("find", &["robots discover"]),
    ("home", &["toyo home", "yrcx origin"]),
    ("homing", &["toyo home", "yrcx origin"]),
    ("inventory", &["robots list"]),
    ("job list", &["yerc file list"]),
    ("jobs", &["yerc file list"]),
    ("jog", &["toyo jog", "yrcx jog", "yerc move relative"]),
    ("list", &["yerc file list", "toyo program list", "robots list"]),
    ("list job", &["yerc file list"]),
    ("list jobs", &["yerc file list"]),
    ("load", &["yerc job select", "yrcx program select"]),
    ("ls", &["yerc file list", "toyo program list", "robots list"]),
    ("monitor", &["top"]),
    ("move", &["yrcx move", "yerc move joint", "toyo run point"]),
    ("origin", &["yrcx origin", "toyo home"]),
    ("pause", &["yerc hold on", "yrcx stop", "toyo stop"]),
    ("ping", &["robots check"]),
    ("pos", &["yerc position", "yrcx position", "toyo position"]),
    ("position", &["yerc position", "yrcx position", "toyo position"]),
    ("power", &["yerc servo", "yrcx power-on", "toyo servo"]),
    ("programs", &["yerc file list", "toyo program list"]),
    ("remove", &["yerc file delete", "toyo program delete"]),
    ("reset", &["yerc alarm reset", "yrcx alarm reset", "toyo alarm reset"]),
    ("rm", &["yerc file delete", "toyo program delete"]),
    ("run", &["yerc job start", "yrcx run", "toyo run"]),
    ("scan", &["robots discover"]),
    ("search", &["robots discover"]),
    ("shell", &["repl"]),
    ("start", &["yerc job select", "yerc job start", "yrcx run", "toyo run"]),
    ("stop", &["yerc hold on", "yrcx stop", "toyo stop"]),
    ("upload", &["yerc file put", "toyo program put"]),
    ("version", &["--version", "yerc info", "yrcx info version", "toyo info"]),
    ("watch", &["top", "status --watch"]),
    ("where", &["yerc position", "yrcx position", "toyo position"]),
];

/// What a family has not, though others have: the family, the words for it, and what there is instead.
pub const ABSENT: &[(&str, &[&str], &str)] = &[(
    "yerc",
    &["home", "homing", "origin"],
    "the protocol has no return to origin; a job that leads there has it (see `armctl yerc job -h`), and the mechanical \
     origin is set at the pendant",
)];

/// Other words for verbs, and what they are behind a noun that has one of these.
pub const VERBS: &[(&str, &[&str])] = &[
    ("clear", &["reset", "cancel", "delete"]),
    ("del", &["delete", "remove"]),
    ("dir", &["list", "show"]),
    ("download", &["get"]),
    ("execute", &["start", "run"]),
    ("load", &["select", "put"]),
    ("ls", &["list", "show"]),
    ("read", &["get", "list", "show", "in"]),
    ("remove", &["delete"]),
    ("rm", &["delete", "remove"]),
    ("run", &["start"]),
    ("show", &["get", "list"]),
    ("start", &["run"]),
    ("upload", &["put"]),
    ("write", &["set", "put"]),
];
