// SPDX-License-Identifier: BSD-3-Clause
//! A port of the PX4 multicopter attitude controller for attest.
//!
//! This file is the shared library: the functions of `attest_unit.h`. `main.rs` is the same port as
//! a program. A panic never crosses the C ABI: it becomes `ATTEST_FAILED`, or null in `create`.

pub mod abi;
pub mod law;
pub mod parameters;
pub mod tailsitter;
pub mod unit;
pub mod vector;

use std::ffi::{c_char, c_int, c_void, CStr};
use std::panic::{catch_unwind, AssertUnwindSafe};

use abi::{Inputs, Outputs, UnitTable};
use law::Profile;
use unit::Unit;

static UNIT_TABLE: UnitTable = UnitTable {
    abi_version: abi::ABI_VERSION,
    name: c"attest-starter-rust".as_ptr(),
    version: concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast(),
    create,
    destroy,
    set_parameter,
    step,
    extension: None,
};

/// The one exported symbol.
#[no_mangle]
pub extern "C" fn attest_unit_v1() -> *const UnitTable {
    &UNIT_TABLE
}

/// The text of a C string, if it is valid UTF-8.
///
/// # Safety
/// `text` is null or a string that ends in a zero byte and lives for `'a`.
unsafe fn text_of<'a>(text: *const c_char) -> Option<&'a str> {
    if text.is_null() {
        return None;
    }
    unsafe { CStr::from_ptr(text) }.to_str().ok()
}

/// Runs `action`. A panic in it gives `ATTEST_FAILED`.
fn guarded(action: impl FnOnce() -> c_int) -> c_int {
    catch_unwind(AssertUnwindSafe(action)).unwrap_or(abi::FAILED)
}

/// # Safety
/// `profile` is null or a C string.
unsafe extern "C" fn create(profile: *const c_char) -> *mut c_void {
    let profile = unsafe { text_of(profile) }.and_then(Profile::from_name);
    let made = catch_unwind(|| profile.map(|profile| Box::new(Unit::new(profile))));
    match made {
        Ok(Some(unit)) => Box::into_raw(unit).cast(),
        _ => std::ptr::null_mut(),
    }
}

/// # Safety
/// `instance` is from `create`, and is not used again.
unsafe extern "C" fn destroy(instance: *mut c_void) {
    if !instance.is_null() {
        drop(unsafe { Box::from_raw(instance.cast::<Unit>()) });
    }
}

/// # Safety
/// `instance` is from `create`, `name` is null or a C string.
unsafe extern "C" fn set_parameter(
    instance: *mut c_void,
    name: *const c_char,
    value: f32,
) -> c_int {
    let unit = unsafe { &mut *instance.cast::<Unit>() };
    let name = unsafe { text_of(name) };
    guarded(|| match name {
        Some(name) if unit.set_parameter(name, value) => abi::OK,
        _ => abi::INVALID,
    })
}

/// # Safety
/// `instance` is from `create`; `inputs` and `outputs` point to structs of the ABI.
unsafe extern "C" fn step(
    instance: *mut c_void,
    inputs: *const Inputs,
    outputs: *mut Outputs,
) -> c_int {
    let unit = unsafe { &mut *instance.cast::<Unit>() };
    let (inputs, outputs) = unsafe { (&*inputs, &mut *outputs) };
    guarded(|| {
        unit.step(inputs, outputs);
        abi::OK
    })
}
