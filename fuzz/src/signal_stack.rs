//! A stack for the signal handler of libFuzzer, so that an input that exhausts the stack is written down as a crash.
//!
//! The runtime of Rust would provide one, but libFuzzer has the `main` and it never starts.

/// Bytes of that stack: the handler formats a message and writes a file.
const BYTES: usize = 256 << 10;

/// Gives this thread the stack, for the life of the program.
#[allow(
    unsafe_code,
    reason = "one system call that no safe crate of this project wraps"
)]
pub fn install() {
    let memory: &'static mut [u8] = Box::leak(vec![0; BYTES].into_boxed_slice());
    let stack = libc::stack_t {
        ss_sp: memory.as_mut_ptr().cast(),
        ss_flags: 0,
        ss_size: memory.len(),
    };
    // SAFETY: the memory is writable, of the given size, and is never freed or used for anything else.
    let installed = unsafe { libc::sigaltstack(&raw const stack, std::ptr::null_mut()) };
    assert_eq!(installed, 0, "no stack for signals");
}
