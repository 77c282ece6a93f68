//! Reads of several items. Each item has its own result, so that a refusal does not prevent the report of the other
//! answers.

use super::eeprom::STORED_VALUE;
use super::link::Refusal;
use super::refusal;
use crate::prelude::*;

/// The answer or the failure of each request.
pub type Answers = Vec<Result<Record>>;

/// Reads items in order. Each item has its own result. After a lost connection, the remaining items are not read. A dry
/// run records all requests and ends.
///
/// # Errors
/// The first failure, if no item was answered.
pub async fn read_each(link: &mut Link, screen: &Screen, what: &str, requests: &[Request]) -> Result<Answers> {
    read(link, screen, what, requests, 1, |_| false).await
}

/// Like [`read_each`], but ends after the first answer for which `is_last` is true.
///
/// # Errors
/// Like [`read_each`].
pub async fn read_until(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    requests: &[Request],
    is_last: impl Fn(&Record) -> bool,
) -> Result<Answers> {
    read(link, screen, what, requests, 1, is_last).await
}

/// Like [`read_each`], but a refused request is sent a second time, because a busy controller also refuses.
///
/// # Errors
/// Like [`read_each`].
pub async fn read_each_with_retry(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    requests: &[Request],
) -> Result<Answers> {
    read(link, screen, what, requests, 2, |_| false).await
}

async fn read(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    requests: &[Request],
    times: u8,
    is_last: impl Fn(&Record) -> bool,
) -> Result<Answers> {
    if times > 1 && link.is_dry_run() {
        for request in requests {
            plan_retry(link, request);
        }
        return Err(unknown());
    }
    link.plan_all(requests)?;
    let mut progress = (requests.len() > 1).then(|| screen.items_progress(what, requests.len() as u64));
    let mut answers = Answers::with_capacity(requests.len());
    let mut silence: Option<Failure> = None;
    for request in requests {
        let answer = match &silence {
            Some(silence) => Err(not_requested(request, silence)),
            None => outcome(link, request, times).await?,
        };
        if let Err(failure) = &answer
            && failure.kind == Kind::NoAnswer
            && silence.is_none()
        {
            silence = Some(failure.clone());
            if !answers.iter().any(Result::is_ok) {
                return Err(failure.clone());
            }
        }
        let ends = answer.as_ref().is_ok_and(&is_last);
        answers.push(answer);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
        if ends {
            break;
        }
    }
    match answers.first() {
        Some(Err(first)) if answers.iter().all(Result::is_err) => Err(first.clone()),
        _ => Ok(answers),
    }
}

/// In a dry run, records a request that is sent a second time after a refusal. A controller without the item refuses
/// the request.
pub fn plan_retry(link: &mut Link, request: &Request) {
    link.plan(request, STORED_VALUE);
    if request.parameter().is_some_and(|parameter| !parameter.only_on.is_empty()) {
        link.plan_if(
            request,
            "whether the controller refuses the first request: a busy controller also refuses, so \
                               armctl sends the request again",
        );
    }
}

/// Answer to one request, or the reason why there is none. A failure ends the whole work.
async fn outcome(link: &mut Link, request: &Request, times: u8) -> Result<Result<Record>> {
    for _ in 1..times {
        match link.try_ask(request).await {
            Ok(Err(_)) => {}
            Ok(Ok(record)) => return Ok(Ok(record)),
            Err(failure) => return as_item_result(failure),
        }
    }
    match link.try_ask(request).await {
        Ok(Ok(record)) => Ok(Ok(record)),
        Ok(Err(Refusal(request))) => Ok(Err(refusal::of_question(&request))),
        Err(failure) => as_item_result(failure),
    }
}

/// Returns a failure as a result if it concerns only one request, otherwise as an error.
fn as_item_result(failure: Failure) -> Result<Result<Record>> {
    if matches!(failure.kind, Kind::NoAnswer | Kind::Malformed) { Ok(Err(failure)) } else { Err(failure) }
}

fn not_requested(request: &Request, silence: &Failure) -> Failure {
    let message = format!("{} was not sent, because an earlier answer was lost: {}", request.text(), silence.message);
    Failure { message, ..silence.clone() }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};
    use armctl_frame::failure::Kind;

    fn with_faults(faulty_block: &'static str, fault: Fault) -> Bench {
        Bench::with_faults("", move |block, _| if block == faulty_block { fault } else { Fault::None }).0
    }

    #[test]
    fn one_refusal_does_not_hide_other_answers_and_names_its_block() {
        for (words, name, block) in [
            (["counter", "get", "1-3"], "CN02", "MCNT CN=02"),
            (["timer", "get", "1-3"], "TN2", "MTMR TN=2"),
            (["speed-table", "get", "1-3"], "speed-table row 2", "RPAR T2 V02"),
            (["accel-table", "get", "1-3"], "accel-table row 2", "RPAR T3 A02"),
            (["torque-table", "get", "1-3"], "torque-table row 2", "RPAR T5 LIM02"),
            (["easy", "get", "1-3"], "easy program 2", "RESY PNO=02 ST=000"),
            (["mvm", "get", "1-3"], "group 2", "RPAR T4 S3 GRP=02"),
            (["point", "get", "1-3"], "point 2", "RPAR T1 PT=002"),
        ] {
            let request = Box::leak(format!("@{block}").into_boxed_str());
            let (data, failure) = with_faults(request, Fault::Answered("@NG")).run(&words).unwrap();
            let items = data["items"].as_array().unwrap();
            assert_eq!(items.len(), 3, "{data}");
            assert_eq!(
                (&items[0]["ok"], &items[1]["ok"], &items[2]["ok"]),
                (&true.into(), &false.into(), &true.into())
            );
            let error = &items[1]["error"];
            assert_eq!((&error["kind"], &error["code"]), (&"refused".into(), &"NG".into()));
            assert_eq!((&error["asked"], &items[1]["value"]), (&name.into(), &serde_json::Value::Null));
            let failure = failure.unwrap();
            assert_eq!(failure.kind, Kind::Mixed);
            let expected =
                format!("1 of 3 failed: {name}: the controller refused {block} (@NG): the status shows no reason");
            assert_eq!(failure.message, expected);
        }
    }

    #[test]
    fn after_a_lost_answer_no_more_items_are_read() {
        let (data, failure) = with_faults("@MCNT CN=02", Fault::Lost).run(&["counter", "get", "1-9"]).unwrap();
        let kinds: Vec<_> =
            data["items"].as_array().unwrap().iter().map(|item| item["error"]["kind"].clone()).collect();
        assert!(kinds[0].is_null() && kinds[1..].iter().all(|kind| kind == "no_answer"), "{data}");
        assert!(
            data["items"][2]["error"]["message"]
                .as_str()
                .unwrap()
                .starts_with("@MCNT CN=03 was not sent, because an earlier answer was lost")
        );
        assert_eq!(failure.unwrap().kind, Kind::Mixed);
        let failure = with_faults("@MCNT CN=01", Fault::Lost).run(&["counter", "get", "1-9"]).unwrap_err();
        assert_eq!(failure.kind, Kind::NoAnswer);
        let failure = with_faults("@MCNT CN=01", Fault::Answered("@NG")).run(&["counter", "get", "1"]).unwrap_err();
        assert_eq!(failure.kind, Kind::Refused);
    }

    #[test]
    fn values_outside_the_manual_are_shown_unchanged() {
        for (block, answer, raw) in [
            ("@RPAR M18", "@RPAR M18 STN=01 BRT=156K", "M18 STN=01 BRT=156K"),
            ("@RPAR P06", "@RPAR P06 AX1=+0000.50 AX2=+0000.5 AX3=+0001.234 AX4=+0000.00", "+0000.5"),
            ("@RPAR E17", "@RPAR E17 E=I", "I"),
            ("@RPAR E19", "@RPAR E19 1130", "1130"),
        ] {
            let mut bench = with_faults(block, Fault::Answered(answer));
            let data = bench.data(&["param", "list"]);
            let id = &block[6..];
            let entry = data["items"].as_array().unwrap().iter().find(|entry| entry["id"] == id).unwrap();
            assert_eq!((&entry["ok"], &entry["in_manual"]), (&true.into(), &false.into()), "{entry}");
            let odd: Vec<_> =
                entry["value"].as_array().unwrap().iter().filter(|one| one["in_manual"] == false).collect();
            assert_eq!(odd[0]["raw"], raw, "{entry}");
            let others = data["items"].as_array().unwrap().iter().filter(|entry| entry["in_manual"] == true);
            assert!(others.count() > 50);
            // A value that is not in the manual is not written back.
            if id == "P06" {
                let failure = bench.run(&["param", "set", "P06", "ax1=1"]).unwrap_err();
                assert!(failure.message.contains("'ax2=+0000.5' is not in the manual"), "{failure}");
                assert_eq!(failure.hint.unwrap(), "type all values; nothing was written");
            }
            let folder = tempfile::tempdir().unwrap();
            let dumped = bench.data(&["param", "dump", folder.path().join("p.csv").to_str().unwrap(), id]);
            assert_eq!((&dumped["saved"], &dumped["left_out"][0]["name"]), (&0.into(), &entry["name"]));
            assert!(dumped["left_out"][0]["why"].as_str().unwrap().ends_with("is not in the manual"), "{dumped}");
        }
        let mut bench = with_faults("@RPAR T2 V02", Fault::Answered("@RPAR T2 V02=250"));
        let rows = bench.data(&["speed-table", "get", "1-2"]);
        let row = &rows["items"][1];
        let unlisted = (&false.into(), &"T2 V02=250".into(), &serde_json::Value::Null);
        assert_eq!((&row["in_manual"], &row["raw"], &row["value"]), unlisted);
        let mut bench = Bench::with_faults("steps = { 1 = [\"SPD V=05\", \"NOP\", \"END\"] }", |block, _| {
            if block == "@RSTX 0002" { Fault::Answered("@RSTX 0002 FOO X=1") } else { Fault::None }
        })
        .0;
        let program = bench.data(&["program", "get", "--to", "4"]);
        assert_eq!(program["text"], "SPD V=05\nFOO X=1   # not in the manual\nEND\nNOP\n");
        assert_eq!(
            program["steps"][1],
            serde_json::json!({ "ok": true, "step": 2, "instruction": "FOO X=1", "in_manual": false })
        );
    }
}
