//! PROFIBUS: telegrams and their contents, GSD files.

use armctl_transport::profibus::gsd::Gsd;
use armctl_transport::profibus::listener::Listener;
use armctl_transport::profibus::wire::{
    Configuration, Diagnosis, GlobalControl, Parameters, Parsed, Piece, Stream, Telegram,
};

use super::seen;

pub fn telegram(data: &[u8]) {
    let mut stream = Stream::default();
    let mut listener = Listener::new(5);
    for piece in data.chunks(7) {
        stream.push(piece);
        listener.handle(piece);
        while let Some(piece) = stream.next_piece() {
            seen(format!("{piece:?}"));
            if let Piece::Telegram(Telegram::Frame(frame), _) = piece {
                content(&frame.data);
            }
        }
        seen(stream.missing());
    }
    seen(format!("{:?}", listener.heard));
    if let Ok(Parsed::Whole(telegram, length)) = Telegram::parse(data) {
        assert!(length <= data.len());
        assert_eq!(Telegram::parse(&telegram.emit()), Ok(Parsed::Whole(telegram.clone(), telegram.emit().len())));
    }
    content(data);
}

fn content(data: &[u8]) {
    if let Ok(diagnosis) = Diagnosis::parse(data) {
        assert_eq!(Diagnosis::parse(&diagnosis.emit()).as_ref(), Ok(&diagnosis));
        seen((diagnosis.to_string(), diagnosis.flag_texts().collect::<Vec<_>>()));
    }
    if let Ok(configuration) = Configuration::parse(data) {
        seen(format!("{configuration:?} {} {}", configuration.input(), configuration.output()));
    }
    if let Ok(parameters) = Parameters::parse(data) {
        assert_eq!(Parameters::parse(&parameters.emit()).as_ref(), Ok(&parameters));
    }
    if let Ok(control) = GlobalControl::parse(data) {
        seen(control.to_string());
    }
}

pub fn gsd(data: &[u8]) {
    match Gsd::parse(data) {
        Err(error) => {
            assert!(error.line >= 1, "{error}");
            seen(error.to_string());
        }
        Ok(gsd) => {
            let names: Vec<&str> = gsd.modules.iter().map(|module| &*module.name).take(8).collect();
            seen((gsd.assemble(&names), gsd.fitting(48, 48)));
        }
    }
}

pub fn gsd_files() -> Vec<Vec<u8>> {
    const FILE: &str = "; a slave\r\n#Profibus_DP\nGSD_Revision = 3\nVendor_Name = \"Somebody; else\" ; a comment\n\
        Model_Name  = \"Robot\"\nIdent_Number = 0x1234\nSlave_Family = 3@TdF@Robots\n9.6_supp = 1\n500_supp = 1\n\
        12M_supp = 1\nMaxTsdr_9.6 = 60\nModular_Station = 1\nMax_Module = 4\nUser_Prm_Data_Len = 5\n\
        User_Prm_Data = 0x00, 0x00, \\\n 0x00\nExt_User_Prm_Data_Const(3) = 0x10, 0x20\n\
        Module = \"24 words in, out\" 0xC0, 0xD7, \\\n  0xD7\n1\nExt_Module_Prm_Data_Len = 2\n\
        Ext_User_Prm_Data_Const(0) = 0x01,0x02\nEndModule\nModule = \"2 words\" 0x71\nEndModule\n";
    vec![FILE.into(), FILE.replace("Modular_Station = 1", "Modular_Station = 0").into()]
}
