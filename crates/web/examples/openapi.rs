//! Prints how the server is reported to a program; `cargo xtask web` makes the types of the page from it.

// An example prints what it is requested.
#![allow(clippy::print_stdout)]

fn main() {
    println!("{}", armill_web::openapi_document());
}
