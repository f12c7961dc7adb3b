//! Task files, as they are and over a type of the user's.

tltl::include_tltl!("ui/tasks/rust.tltl");

pub(crate) struct Mine {
    pub(crate) x: f64,
}
tltl::include_tltl!("ui/tasks/rust.tltl", state = Mine, mod = mine);

pub(crate) fn main() {
    assert_eq!(rust::t().satisfied(&[rust::S { x: 2.0 }]), Ok(true));
    assert_eq!(mine::t().satisfied(&[Mine { x: 4.0 }]), Ok(false));
}
