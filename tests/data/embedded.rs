// Follows the automaton, and the robustness. The fields are private, so rustc makes no code but what
// these functions call.
macro_rules! run {
    ($($name:ident: $module:ident::$task:ident, $state:ident;)*) => {$(
        pub mod $name {
            use crate::$module::{$state, $task};

            static TASK: tltl::Task<$task> = $task();
            pub static MEMORY: [u8; size_of::<Monitor>()] = [0; size_of::<Monitor>()];

            pub struct Monitor(tltl::task::Run<'static, $task>);

            impl Monitor {
                #[inline(never)]
                pub fn begin() -> Self {
                    Self(TASK.run())
                }

                #[inline(never)]
                pub fn step(&mut self, s: &$state) -> Option<bool> {
                    self.0.step(s).ok()?
                }
            }
        }
    )*};
}

macro_rules! online {
    ($($name:ident: $module:ident::$task:ident, $state:ident;)*) => {$(
        pub mod $name {
            use crate::$module::{$state, $task};

            static TASK: tltl::Task<$task> = $task();
            pub static MEMORY: [u8; size_of::<Monitor>()] = [0; size_of::<Monitor>()];

            pub struct Monitor(tltl::task::Online<'static, $task>);

            impl Monitor {
                #[inline(never)]
                pub fn begin() -> Self {
                    Self(TASK.online())
                }

                #[inline(never)]
                pub fn step(&mut self, s: &$state) -> Option<(f64, f64, Option<bool>)> {
                    let interval = self.0.step(s).ok()?;
                    Some((interval.lower, interval.upper, self.0.verdict()))
                }
            }
        }
    )*};
}

