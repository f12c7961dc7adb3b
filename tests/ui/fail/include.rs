//! Task files: the message shows the file's own line, for rustc cannot point there.

tltl::include_tltl!("ui/tasks/broken.tltl"); //~ its mistakes
tltl::include_tltl!("ui/tasks/none.tltl"); //~ no such file
tltl::include_tltl!(broken); //~ not a string
tltl::include_tltl!("ui/tasks/rust.tltl", name = x); //~ no such option

struct State {
    y: f64,
}
tltl::include_tltl!("ui/tasks/rust.tltl", state = State, mod = other); //~ a type without the field

fn main() {}
