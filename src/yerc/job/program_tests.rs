use crate::prelude::*;
use crate::testing::{DX200, quiet, resolve_robot};

/// Writes a job with these positions and instructions.
fn write_job(folder: &Path, name: &str, positions: &[&str], instructions: &str) {
    let positions: String = positions.iter().enumerate().map(|(at, values)| format!("C{at:05}={values}\n")).collect();
    let text = format!("/JOB\n//NAME {name}\n//POS\n{positions}//INST\nNOP\n{instructions}\nEND\n");
    std::fs::write(folder.join(format!("{name}.JBI")), text.replace('\n', "\r\n")).unwrap();
}

/// Runs a command without a robot.
fn run(words: &str, folder: &Path) -> Result<(Value, Option<Failure>)> {
    let words = words.replace("DIR", folder.to_str().unwrap());
    let (_, command) = resolve_robot(DX200, &words.split(' ').collect::<Vec<_>>()).unwrap();
    let report = command.without_robot(&quiet()).expect("the command needs no robot")?;
    Ok((report.data()?, report.failure()))
}

/// Findings of a check, for example `error missing-label A.JBI:9 …`.
fn findings(words: &str, folder: &Path) -> (Vec<String>, Option<Failure>) {
    let (data, failure) = run(words, folder).unwrap();
    let text = |value: &Value| value.as_str().unwrap().rsplit('/').next().unwrap().to_owned();
    let files = data["files"].as_array().unwrap().iter();
    let all = files.flat_map(|file| {
        let findings = file["findings"].as_array().unwrap().iter();
        findings.map(|one| {
            let [severity, rule, message] = ["severity", "rule", "message"].map(|key| one[key].as_str().unwrap());
            format!("{severity} {rule} {}:{}:{} {message}", text(&file["file"]), one["line"], one["column"])
        })
    });
    (all.collect(), failure)
}

/// Jobs with one fault of each rule.
fn faulty() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let dir = folder.path();
    let main = "*AGAIN\nMOVJ C00000 VJ=90.00\nMOVL C00009 V=100.0\nJUMP *AGIAN IF B001<3\nCALL JOB:SUBB\nCALL JOB:SUB\n\
                SET B005 1\nSET LB000 1\nINC D000";
    write_job(dir, "MAIN", &["0,0,0,0,0,0", "1,2,3,4,5,6"], main);
    write_job(dir, "SUB", &[], "CALL JOB:DEEP\nSET B001 LB000");
    write_job(dir, "DEEP", &[], "CALL JOB:SUB IF IN#(1)=ON");
    write_job(dir, "OLD", &[], "'B005\nJUMP JOB:OLD");
    std::fs::write(dir.join("BARE.JBI"), "/JOB\n//NAME OTHER\nNOP\n").unwrap();
    std::fs::write(dir.join(".armctl-check.toml"), "max-speed = [\"500mm/s\", \"50%\"]\nmaster = [\"MAIN\"]\n")
        .unwrap();
    folder
}

#[test]
fn planted_faults_are_found() {
    let folder = faulty();
    let (found, failure) = findings("job check --from DIR", folder.path());
    assert_eq!(
        found,
        [
            "error syntax BARE.JBI:1:1 this file is not a job: the line END is missing",
            "error syntax BARE.JBI:1:1 the file of the job BARE has the name OTHER in //NAME",
            "warning line-endings BARE.JBI:1:1 the line ends in LF without CR; jobs need CR LF",
            "warning unused-job BARE.JBI:1:1 no job calls BARE",
            "warning recursion DEEP.JBI:6:6 this call of SUB leads to another call of DEEP",
            "warning unused-position MAIN.JBI:5:1 no instruction uses C1",
            "warning speed-limit MAIN.JBI:9:13 90% is above the limit 50%",
            "error missing-position MAIN.JBI:10:6 MAIN has no position C9",
            "error missing-label MAIN.JBI:11:6 MAIN has no label AGIAN",
            "warning missing-job MAIN.JBI:12:6 SUBB does not exist",
            "warning never-read MAIN.JBI:14:5 no instruction reads B5",
            "warning never-read MAIN.JBI:15:5 no instruction reads LB0",
            "warning unused-job OLD.JBI:2:1 no job calls OLD",
            "warning recursion SUB.JBI:6:6 this call of DEEP leads to another call of SUB",
        ]
    );
    let failure = failure.unwrap();
    assert_eq!((failure.kind.exit(), failure.message.contains("2 of 5 files have errors")), (8, true), "{failure}");

    let settings = "max-speed = [\"90%\"]\n[rules]\nmissing-label = false\nmissing-job = false\nmissing-position = \
                    false\nrecursion = false\n[ignore]\n\"M*\" = [\"never-read\"]\n\"OLD\" = []\nBARE = []\n";
    std::fs::write(folder.path().join(".armctl-check.toml"), settings).unwrap();
    let (found, failure) = findings("job check MAIN OLD SUB --from DIR", folder.path());
    assert_eq!(found, ["warning unused-position MAIN.JBI:5:1 no instruction uses C1"], "rules can be switched off");
    assert!(failure.is_none());
    let failure = findings("job check MAIN --from DIR --strict", folder.path()).1.unwrap();
    assert!(failure.message.ends_with("MAIN.JBI has warnings"), "{failure}");
}

#[test]
fn right_jobs_have_no_findings() {
    let folder = tempfile::tempdir().unwrap();
    let main = "*TOP\nMOVJ C00000 VJ=50.00\nMOVL P001 V=200.0\nCALL JOB:部品 IF B001=1\nSET D000 B[I000]\nSET B002 D000\n\
                IFTHENEXP IN#(1)=ON\n   DOUT OT#(1) ON\nENDIF\nCALL IG#(1)\nMSG \"JUMP *NOWHERE\"\n'CALL JOB:GONE\n\
                //JUMP *GONE\nJUMP *TOP UNLESS B002=0";
    write_job(folder.path(), "MAIN", &["0,0,0,0,0,0"], main);
    write_job(folder.path(), "部品", &[], "INC I000\nPSTART JOB:MAIN SUB1\nGRIP");
    write_job(folder.path(), "GRIP", &[], "PULSE OT#(2) T=0.50\nRET");
    assert_eq!(findings("job check --from DIR --max-speed 500mm/s,50%", folder.path()).0, [""; 0]);
    let contract = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data/contract/backup-yerc");
    assert_eq!(findings("job check --from DIR", &contract).1, None);
}

#[test]
fn compares_positions_in_their_order() {
    let (old, new) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let all = |count: usize| (0..count).map(|at| format!("MOVJ C{at:05} VJ=1.00\n")).collect::<String>();
    write_job(old.path(), "A", &["0,0", "10,0", "1.000,2.000,3.000,4.0000"], &all(3));
    write_job(new.path(), "A", &["5,5", "0,0", "19,0", "1.050,2.000,3.000,4.0000"], &all(4));
    let words = format!("job check --from DIR --compare {}", old.path().display());
    let (found, failure) = findings(&words, new.path());
    let place = old.path().join("A.JBI");
    let expected = [
        format!("warning moved-position A.JBI:6:1 C2 is 19,0, and was 10,0 in {}", place.display()),
        "warning moved-position A.JBI:7:1 C3 is 1.050,2.000,3.000,4.0000, and was 1.000,2.000,3.000,4.0000 in "
            .to_owned()
            + &place.display().to_string(),
    ];
    assert_eq!((&found[..], failure), (&expected[..], None));
    assert_eq!(findings(&format!("{words} --tolerance 0.1mm,10pulses"), new.path()).0, [""; 0]);
}

#[test]
fn search_finds_texts_objects_and_calls() {
    let folder = faulty();
    let name = "/IONAME\r\n//IN\r\nPART,,,\r\n//OUT\r\n,,,\r\n";
    std::fs::write(folder.path().join("IONAME.DAT"), name).unwrap();
    let found = |words: &str| -> Vec<String> {
        let (data, failure) = run(&format!("job search {words} --from DIR"), folder.path()).unwrap();
        assert_eq!(failure, None);
        let matches = data["matches"].as_array().unwrap().iter();
        matches.map(|one| format!("{}:{} {}", one["program"].as_str().unwrap(), one["line"], one["text"])).collect()
    };
    assert_eq!(found("MOV[JL].*V="), ["MAIN:10 \"MOVL C00009 V=100.0\""]);
    assert_eq!(found("movl -i").len(), 1);
    assert_eq!(found("--uses b5"), ["MAIN:14 \"SET B005 1\""]);
    assert_eq!(found("--uses part"), ["DEEP:6 \"CALL JOB:SUB IF IN#(1)=ON\""]);
    assert_eq!(found("--uses IN1 --calls SUB").len(), 1);
    assert_eq!(found("--calls OLD"), ["OLD:7 \"JUMP JOB:OLD\""]);
    assert_eq!(found("nothing"), [""; 0]);
    let failure = run("job search --uses prat --from DIR", folder.path()).unwrap_err();
    assert!(failure.hint.unwrap().starts_with("did you mean PART?"));
}

#[test]
fn calls_show_the_tree_and_what_is_missing() {
    let folder = faulty();
    let (data, _) = run("job calls --from DIR", folder.path()).unwrap();
    let of = |key: &str| -> Vec<&str> {
        let programs = data["programs"].as_array().unwrap().iter();
        programs.filter(|one| one[key] == true).map(|one| one["name"].as_str().unwrap()).collect()
    };
    assert_eq!(of("unused"), ["BARE", "OLD"]);
    assert_eq!(of("recursive"), ["DEEP", "SUB"]);
    let missing = data["programs"].as_array().unwrap().iter().find(|one| one["exists"] == false).unwrap();
    assert_eq!((&missing["name"], &missing["called_by"][0]), (&"SUBB".into(), &"MAIN".into()));
    let (data, _) = run("job calls DEEP --from DIR", folder.path()).unwrap();
    assert_eq!(data["programs"].as_array().unwrap().len(), 2);
    let failure = run("job calls DEPE --from DIR", folder.path()).unwrap_err();
    assert_eq!((failure.kind, failure.hint.as_deref()), (Kind::Usage, Some("did you mean DEEP?")));
}

#[tokio::test(start_paused = true)]
async fn jobs_of_a_controller_are_read_once() {
    let mut lines = crate::testing::reports("", &["job search --calls COUNT", "job check", "job calls MAIN"]).await;
    let tree = lines.pop().unwrap().unwrap();
    assert_eq!(tree["programs"].as_array().unwrap().len(), 3, "{tree}");
    let check = lines.pop().unwrap().unwrap();
    assert_eq!(check["files"].as_array().unwrap().len(), 7, "{check}");
    assert_eq!(lines.pop().unwrap().unwrap()["matches"][0]["program"], "MAIN");
}
