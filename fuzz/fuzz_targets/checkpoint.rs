#![cfg_attr(fuzzing, no_main)]

#[cfg(fuzzing)]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    (moldwarp_fuzz::targets::CHECKPOINT.run)(bytes);
});

#[cfg(not(fuzzing))]
#[global_allocator]
static MEMORY: moldwarp_fuzz::memory::Bounded = moldwarp_fuzz::memory::Bounded;

#[cfg(not(fuzzing))]
fn main() -> std::process::ExitCode {
    moldwarp_fuzz::runner::main(&moldwarp_fuzz::targets::CHECKPOINT)
}
