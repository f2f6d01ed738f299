// SPDX-License-Identifier: BSD-3-Clause
//! The port as a program: answers the requests of attest in binary frames, from stdin to stdout.
//! The protocol is described in `harness/port/PROTOCOL.md`.
//!
//! stdout is for answers only. A panic ends the program with a message on stderr, and attest
//! reports a crash.

mod wire;

use std::collections::hash_map::{Entry, HashMap};
use std::ffi::c_int;
use std::io::{self, BufRead, BufWriter, Read, Write};

use attest_starter_rust::abi::{self, Outputs};
use attest_starter_rust::law::Profile;
use attest_starter_rust::unit::Unit;
use wire::{Header, Reader};

/// The kinds of requests.
const CREATE: u32 = 1;
const DESTROY: u32 = 2;
const SET_PARAMETER: u32 = 3;
const STEP: u32 = 4;
const BATCH: u32 = 5;

/// The number of the controller among the modules of `create`.
const CONTROLLER: u32 = 0;

/// The answer to the handshake. The program has only one version of the protocol, so it does not
/// parse the request: attest refuses a version that it does not understand.
const HANDSHAKE: &str = concat!(
    r#"{"protocol":1,"name":"attest-starter-rust","version":""#,
    env!("CARGO_PKG_VERSION"),
    r#"","profiles":["px4-v1.5.5","px4-v1.3.4"],"frames":"binary","batch":true}"#
);

fn main() -> io::Result<()> {
    let mut requests = io::stdin().lock();
    // Buffered, so that a short answer is one write.
    let mut answers = BufWriter::new(io::stdout().lock());

    requests.read_until(b'\n', &mut Vec::new())?;
    writeln!(answers, "{HANDSHAKE}")?;
    answers.flush()?;

    let mut units = Units::new();
    let mut payload = Vec::new();
    while let Some(header) = Header::read(&mut requests)? {
        payload.resize(header.size as usize, 0);
        requests.read_exact(&mut payload)?;
        let answer = serve(&mut units, &header, &payload);
        header.answered_with(&answer).write(&mut answers)?;
        answers.write_all(&answer)?;
        answers.flush()?;
    }
    Ok(())
}

/// The units that exist, by their numbers.
type Units = HashMap<u32, Unit>;

/// The payload of the answer to one request.
fn serve(units: &mut Units, header: &Header, payload: &[u8]) -> Vec<u8> {
    let payload = Reader::new(payload);
    match header.kind {
        CREATE => result(create(units, header.unit, payload)),
        DESTROY => result(match units.remove(&header.unit) {
            Some(_) => abi::OK,
            None => abi::INVALID,
        }),
        SET_PARAMETER => result(set_parameter(units, header.unit, payload)),
        STEP => step(units, header.unit, payload),
        BATCH => batch(units, header.unit, payload),
        _ => result(abi::UNSUPPORTED),
    }
}

fn result(code: c_int) -> Vec<u8> {
    code.to_le_bytes().to_vec()
}

/// Payload: u32 module, u32 length of the profile, profile. The mixer's definition is not used.
fn create(units: &mut Units, number: u32, mut payload: Reader) -> c_int {
    let (Some(module), Some(length)) = (payload.u32(), payload.u32()) else {
        return abi::INVALID;
    };
    let Some(profile) = payload.text(length as usize) else {
        return abi::INVALID;
    };
    match (units.entry(number), Profile::from_name(profile)) {
        (Entry::Occupied(_), _) => abi::INVALID,
        (Entry::Vacant(place), Some(profile)) if module == CONTROLLER => {
            place.insert(Unit::new(profile));
            abi::OK
        }
        _ => abi::UNSUPPORTED,
    }
}

/// Payload: f32 value, name.
fn set_parameter(units: &mut Units, number: u32, mut payload: Reader) -> c_int {
    let (Some(unit), Some(value)) = (units.get_mut(&number), payload.f32()) else {
        return abi::INVALID;
    };
    match payload.text(payload.remaining()) {
        Some(name) if unit.set_parameter(name, value) => abi::OK,
        _ => abi::INVALID,
    }
}

/// Payload: one step. The answer has outputs with every result.
fn step(units: &mut Units, number: u32, mut payload: Reader) -> Vec<u8> {
    let mut outputs = Outputs::default();
    let code = run_step(units.get_mut(&number), &mut payload, &mut outputs);
    let mut answer = result(code);
    wire::write_outputs(&outputs, &mut answer);
    answer
}

/// Payload: u32 number of steps, u32 zero, the steps. A step that is not ok ends the batch.
fn batch(units: &mut Units, number: u32, mut payload: Reader) -> Vec<u8> {
    let mut code = abi::OK;
    let mut done: u32 = 0;
    let mut all_outputs = Vec::new();
    let (Some(steps), Some(_)) = (payload.u32(), payload.u32()) else {
        return [result(abi::INVALID), result(0)].concat();
    };
    while done < steps {
        let mut outputs = Outputs::default();
        code = run_step(units.get_mut(&number), &mut payload, &mut outputs);
        if code != abi::OK {
            break;
        }
        wire::write_outputs(&outputs, &mut all_outputs);
        done += 1;
    }
    [result(code), done.to_le_bytes().to_vec(), all_outputs].concat()
}

/// One step: u64 `timestamp_sample`, which the law does not need, and the inputs.
fn run_step(unit: Option<&mut Unit>, payload: &mut Reader, outputs: &mut Outputs) -> c_int {
    let (Some(unit), Some(_), Some(inputs)) = (unit, payload.u64(), payload.inputs()) else {
        return abi::INVALID;
    };
    unit.step(&inputs, outputs);
    abi::OK
}
