//! The only module with `unsafe`: names that the worker calls, and where bytes are in linear memory.
//!
//! The worker asks for room by [`take`], writes there, and calls [`open`], [`mesh`], [`tracing`], [`draw`] or [`pick`]. These return 0, or 1
//! if they failed. Then the document, or what failed, is at [`told`], and bytes are at [`bytes`]: until the next call, and
//! in a view of the memory that is made after the call, since memory may grow. After a panic the module is not to be used
//! any more, but [`told`] has its text.
//!
//! **Safety.** No pointer is read here: the attribute that gives a function its plain name is the only thing that the
//! compiler calls unsafe, since another function could have the same name. The linker would refuse two.
#![expect(
    unsafe_code,
    reason = "a function with a name of its own is `unsafe(no_mangle)`"
)]

use std::cell::RefCell;

use crate::calls::{Answer, Calls};

thread_local! {
    static CALLS: RefCell<Calls> = RefCell::default();
    static INPUT: RefCell<Vec<u8>> = RefCell::default();
    static ANSWER: RefCell<Answer> = RefCell::default();
}

/// Room for this many bytes of input.
#[unsafe(no_mangle)]
pub extern "C" fn take(length: usize) -> *mut u8 {
    std::panic::set_hook(Box::new(|panic| keep(Answer::fault(panic.to_string()))));
    INPUT.with_borrow_mut(|input| {
        *input = vec![0; length];
        input.as_mut_ptr()
    })
}

/// Opens the file in the input, whose last bytes, so many, are its name.
#[unsafe(no_mangle)]
pub extern "C" fn open(name: usize) -> u32 {
    let (name, file) = input(name);
    answered(|calls| calls.open(&name, file))
}

/// Makes a file of the surface; the input is the extension of its format.
#[unsafe(no_mangle)]
pub extern "C" fn mesh(level: u32) -> u32 {
    let (format, _) = input(usize::MAX);
    answered(|calls| calls.mesh(&format, level))
}

/// Makes a file of the tracing.
#[unsafe(no_mangle)]
pub extern "C" fn tracing() -> u32 {
    answered(|calls| calls.tracing())
}

/// Draws the view in the input, whose last bytes, so many, are its JSON; before it are colors.
#[unsafe(no_mangle)]
pub extern "C" fn draw(view: usize) -> u32 {
    let (view, colors) = input(view);
    answered(|calls| calls.draw(&view, &colors))
}

/// What is at a pixel of such a view.
#[unsafe(no_mangle)]
pub extern "C" fn pick(view: usize, x: i32, y: i32) -> u32 {
    let (view, colors) = input(view);
    answered(|calls| calls.pick(&view, &colors, [x, y].map(i64::from)))
}

/// Where the document is.
#[unsafe(no_mangle)]
pub extern "C" fn told() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.told.as_ptr())
}

/// Its length (bytes).
#[unsafe(no_mangle)]
pub extern "C" fn told_length() -> usize {
    ANSWER.with_borrow(|answer| answer.told.len())
}

/// Where the bytes are.
#[unsafe(no_mangle)]
pub extern "C" fn bytes() -> *const u8 {
    ANSWER.with_borrow(|answer| answer.bytes.as_ptr())
}

/// Their number.
#[unsafe(no_mangle)]
pub extern "C" fn bytes_length() -> usize {
    ANSWER.with_borrow(|answer| answer.bytes.len())
}

/// Takes the input: text of so many bytes at its end, and what is before it, which is not copied.
fn input(text: usize) -> (String, Vec<u8>) {
    let mut input = INPUT.take();
    let text = input.split_off(input.len().saturating_sub(text));
    (String::from_utf8_lossy(&text).into_owned(), input)
}

fn answered(call: impl FnOnce(&mut Calls) -> Result<Answer, String>) -> u32 {
    keep(Answer::default());
    let answer = CALLS.with_borrow_mut(call);
    let failed = u32::from(answer.is_err());
    keep(answer.unwrap_or_else(Answer::fault));
    failed
}

fn keep(answer: Answer) {
    ANSWER.set(answer);
}
