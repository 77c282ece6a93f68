//! The simulator survives any input.

use proptest::prelude::*;

use super::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_datagrams_are_survived(
        datagrams in proptest::collection::vec(
            (any::<bool>(), 0u64..3, 0u64..5000, proptest::collection::vec(any::<u8>(), 0..560)), 0..20)
    ) {
        let mut simulator = Simulator::new(Start::default());
        let mut now = Now::ZERO;
        for (file, peer, wait, bytes) in datagrams {
            now += Duration::from_millis(wait);
            simulator.receive(now, if file { Division::File } else { Division::Robot }, peer, &bytes);
            while simulator.transmit(now).is_some() {}
        }
    }

    #[test]
    fn any_well_formed_request_is_answered(
        requests in proptest::collection::vec(
            (0x6Eu16..0x90, prop_oneof![0u16..130, 1000u16..1010, any::<u16>()], 0u8..15,
             prop_oneof![Just(0x01u8), Just(0x02), Just(0x0E), Just(0x10), Just(0x33), Just(0x34), any::<u8>()],
             prop_oneof![
                 proptest::collection::vec(any::<u8>(), 0..479),
                 proptest::collection::vec(0u8..3, 4),
                 proptest::collection::vec(0u8..2, 88),
                 proptest::collection::vec(0u8..2, 104)], 0u64..3000), 0..30),
        plural in any::<bool>(), fs100 in any::<bool>(),
    ) {
        let model = if fs100 { Model::Fs100 } else { Model::Dx200 };
        let mut simulator = Simulator::new(Start::for_model(model));
        let mut now = Now::ZERO;
        for (command, instance, attribute, service, data, wait) in requests {
            now += Duration::from_millis(wait);
            let command = if plural { command + 0x292 } else { command };
            let frame = RequestFrame {
                division: Division::Robot, ack: false, id: 1, block: 0, command, instance, attribute, service, data: &data,
            };
            simulator.receive(now, Division::Robot, 0, &frame.emit());
            let answer = simulator.transmit(now).expect("every request is answered");
            let answer = AnswerFrame::parse(&answer.bytes).expect("answers are frames");
            prop_assert_eq!(answer.block, LAST_BLOCK);
            prop_assert!(answer.status.is_ok() || answer.data.is_empty());
        }
    }

    #[test]
    fn any_file_frames_are_survived(
        frames in proptest::collection::vec(
            (any::<bool>(), 0u64..2, 0u8..3,
             prop_oneof![Just(0x09u8), Just(0x15), Just(0x16), Just(0x32), any::<u8>()],
             prop_oneof![0u32..4, (0u32..4).prop_map(|block| block | LAST_BLOCK), any::<u32>()],
             prop_oneof![
                 Just(b"TESTJOB.JBI".to_vec()), Just(b"A.DAT".to_vec()), Just(b"".to_vec()),
                 Just(b"/SPDRV/CMOSBK.BIN".to_vec()), proptest::collection::vec(any::<u8>(), 0..479)],
             0u64..3000), 0..30)
    ) {
        let mut simulator = Simulator::new(Start::default());
        let mut now = Now::ZERO;
        for (ack, peer, id, service, block, data, wait) in frames {
            now += Duration::from_millis(wait);
            let frame = RequestFrame {
                division: Division::File, ack, id, block, command: 0, instance: 0, attribute: 0, service, data: &data,
            };
            simulator.receive(now, Division::File, peer, &frame.emit());
            while let Some(answer) = simulator.transmit(now) {
                prop_assert!(AnswerFrame::parse(&answer.bytes).is_ok());
            }
        }
    }
}
