//! TLS with valid and invalid certificates, which `openssl` creates.
#![cfg(feature = "plant-tls")]

use std::fs::Permissions;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Stdio};

use super::broker::{self, Mosquitto, NOT_INSTALLED};
use super::{Publisher, Workspace, fleet, stderr};

fn has_openssl() -> bool {
    Command::new("openssl").arg("version").stdout(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Creates a certificate authority, and certificates for the broker, a client and another broker.
fn certificates(folder: &Path) {
    let script = r#"
set -e
request() { openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj "/CN=$1" "${@:2}"; }
authority() { request "$1" -x509 -days 3 -keyout "$1.key" -out "$1.pem"; }
signed() {
    request "$1" -keyout "$1.key" -out "$1.csr"
    printf 'subjectAltName=%s\nextendedKeyUsage=serverAuth,clientAuth\n' "$2" > "$1.ext"
    openssl x509 -req -in "$1.csr" -CA ca.pem -CAkey ca.key -CAcreateserial -days 3 -extfile "$1.ext" -out "$1.pem"
}
authority ca
authority stranger
signed broker IP:127.0.0.1
signed elsewhere DNS:elsewhere.example
signed client DNS:client.example
"#;
    let mut command = Command::new("bash");
    command.args(["-c", script]).current_dir(folder).stdout(Stdio::null()).stderr(Stdio::null());
    assert!(command.status().unwrap().success(), "the certificates are made");
}

fn publish(workspace: &Workspace, broker: &Mosquitto, more: &[&str]) -> (Option<i32>, String) {
    let url = broker.url().replace("mqtt:", "mqtts:");
    let files: Vec<String> = more
        .iter()
        .map(|word| match word.split_once('.') {
            Some(_) => broker.folder().join(word).display().to_string(),
            None => (*word).to_owned(),
        })
        .collect();
    let mut words = vec!["publish", &url, "--count", "1", "--kinds", "status"];
    words.extend(files.iter().map(String::as_str));
    let output = workspace.run(&words);
    (output.status.code(), stderr(&output))
}

#[test]
fn trusts_a_broker_only_by_its_certificate() {
    if !broker::is_installed() || !has_openssl() {
        return eprintln!("{NOT_INSTALLED}, or there is no openssl");
    }
    let settings = |name: &str, more: &str| {
        format!(
            "allow_anonymous true\ncafile FOLDER/ca.pem\ncertfile FOLDER/{name}.pem\nkeyfile FOLDER/{name}.key\n{more}"
        )
    };
    let workspace = fleet();
    let broker = Mosquitto::with(&settings("broker", ""), certificates);
    let (code, said) = publish(&workspace, &broker, &["--ca", "ca.pem"]);
    assert_eq!(code, Some(0), "{said}");
    for (words, why) in [
        (&["--ca", "stranger.pem"][..], "does not trust the issuer"),
        (&[], "does not trust the issuer"),
        (&["--ca", "ca.key"], "not a certificate in PEM"),
        (&["--ca", "ca.pem", "--cert", "client.pem", "--key", "ca.pem"], "not a private key in PEM"),
    ] {
        let (code, said) = publish(&workspace, &broker, words);
        assert!(code == Some(2) && said.contains(why) && said.contains("hint:"), "{words:?}: {code:?} {said}");
    }

    let other_host = Mosquitto::with(&settings("elsewhere", ""), certificates);
    let (code, said) = publish(&workspace, &other_host, &["--ca", "ca.pem"]);
    assert!(code == Some(2) && said.contains("for another name"), "{said}");

    let strict = Mosquitto::with(&settings("broker", "require_certificate true\n"), certificates);
    let client = ["--ca", "ca.pem", "--cert", "client.pem", "--key", "client.key"];
    let (code, said) = publish(&workspace, &strict, &client);
    assert!(code == Some(0) && !said.contains("can read"), "{said}");
    std::fs::set_permissions(strict.folder().join("client.key"), Permissions::from_mode(0o640)).unwrap();
    let (code, said) = publish(&workspace, &strict, &client);
    assert!(code == Some(0) && said.matches("users of this computer can read this private key").count() == 1, "{said}");
    let (code, said) = publish(&workspace, &strict, &["--ca", "ca.pem"]);
    assert!(code == Some(2) && said.contains("does not accept this client's certificate"), "{code:?} {said}");

    // First, a publisher with TLS at a port without TLS. Then, a publisher without TLS at a port with TLS.
    let plain = Mosquitto::start();
    let (code, said) = publish(&workspace, &plain, &[]);
    assert!(code == Some(2) && said.contains("does not use TLS"), "{code:?} {said}");
    let output = workspace.run(&["publish", &broker.url(), "--count", "1", "--kinds", "status"]);
    assert!(output.status.code() == Some(4) && stderr(&output).contains("mqtts://"), "{}", stderr(&output));
}

#[test]
fn service_waits_for_the_right_certificate() {
    if !broker::is_installed() || !has_openssl() {
        return eprintln!("{NOT_INSTALLED}, or there is no openssl");
    }
    let settings = "allow_anonymous true\ncertfile FOLDER/now.pem\nkeyfile FOLDER/now.key\n";
    let install_certificate = |folder: &Path, name: &str| {
        for end in ["pem", "key"] {
            std::fs::copy(folder.join(format!("{name}.{end}")), folder.join(format!("now.{end}"))).unwrap();
        }
    };
    let mut broker = Mosquitto::with(settings, |folder| {
        certificates(folder);
        install_certificate(folder, "elsewhere");
    });
    let (workspace, ca) = (fleet(), broker.folder().join("ca.pem").display().to_string());
    let url = broker.url().replace("mqtt:", "mqtts:");
    let mut publisher = Publisher::start(workspace.command(&["publish", &url, "--ca", &ca, "--json"]));
    publisher.wait_for_message(
        "the broker's certificate is for another name (use the name in the certificate as the host of the URL); next try",
    );
    broker.kill();
    install_certificate(broker.folder(), "broker");
    broker.start_again();
    publisher.wait_for_message("connected to mqtts://");
    publisher.signal("-TERM");
    assert_eq!(publisher.end().0, Some(0));
}
