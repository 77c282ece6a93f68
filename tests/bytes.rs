//! Bytes of the protocols: golden frames, captures, tables, properties, random bytes. The tests use no sockets and do
//! not run the binary.

mod capture_files;
mod captures;
mod coverage;
mod golden;
mod golden_toyo;
mod properties;
mod random_answers;
mod toyo_properties;
mod toyo_tables;
mod yrcx_golden;
mod yrcx_properties;
