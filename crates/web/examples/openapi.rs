//! Prints the description of the server's interface; `cargo xtask web` makes the types of the page from it.

// An example prints its result.
#![allow(clippy::print_stdout)]

fn main() {
    println!("{}", armill_web::openapi_document());
}
