//! Sets of instructions, and functions that are compiled for each of them.

/// Instructions to compute with. Results are the same with all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Simd(Level);

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd)]
enum Level {
    Scalar,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Default for Simd {
    fn default() -> Simd {
        Simd::best()
    }
}

impl Simd {
    /// Names, as `--simd` takes them.
    pub const NAMES: [&'static str; 3] = ["scalar", "avx2", "avx512"];

    /// The widest that this processor has.
    pub fn best() -> Simd {
        let named = Simd::NAMES.iter().rev().find_map(|name| Simd::named(name));
        named.unwrap_or(Simd(Level::Scalar))
    }

    /// By its name, if this processor has it.
    pub fn named(name: &str) -> Option<Simd> {
        match name {
            "scalar" => Some(Simd(Level::Scalar)),
            #[cfg(target_arch = "x86_64")]
            "avx2" => std::is_x86_feature_detected!("avx2").then_some(Simd(Level::Avx2)),
            #[cfg(target_arch = "x86_64")]
            "avx512" => (std::is_x86_feature_detected!("avx512f")
                && std::is_x86_feature_detected!("avx512dq")
                && std::is_x86_feature_detected!("avx512vl"))
            .then_some(Simd(Level::Avx512)),
            _ => None,
        }
    }

    #[cfg(target_arch = "x86_64")]
    pub(crate) fn has_avx512(self) -> bool {
        self.0 == Level::Avx512
    }

    #[cfg(target_arch = "x86_64")]
    pub(crate) fn has_avx2(self) -> bool {
        self.0 >= Level::Avx2
    }
}

/// Compiles a function once for each instruction set, and calls the one that its first argument asks for.
/// What it calls must be inlined, else it is compiled for the least processor. In it, `S` are the instructions
/// ([`Instructions`](crate::step::Instructions)).
macro_rules! for_each_simd {
    (
        $(#[$doc:meta])*
        $vis:vis fn $name:ident $(<const $flag:ident: bool>)? ($($arg:ident: $type:ty),* $(,)?)
        $(-> $ret:ty)? $body:block
    ) => {
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)]
        $vis fn $name $(<const $flag: bool>)? (
            simd: $crate::lanes::Simd,
            $($arg: $type),*
        ) $(-> $ret)? {
            #[inline(always)]
            #[allow(clippy::too_many_arguments)]
            fn plain<S: $crate::step::Instructions, $(const $flag: bool)?>(
                $($arg: $type),*
            ) $(-> $ret)? $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments)]
                fn avx2 $(<const $flag: bool>)? ($($arg: $type),*) $(-> $ret)? {
                    plain::<$crate::step::Avx2, $($flag)?>($($arg),*)
                }
                #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
                #[allow(clippy::too_many_arguments)]
                fn avx512 $(<const $flag: bool>)? ($($arg: $type),*) $(-> $ret)? {
                    plain::<$crate::step::Avx512, $($flag)?>($($arg),*)
                }
                if simd.has_avx512() {
                    // SAFETY: `Simd` is made only where the processor has it.
                    return unsafe { avx512 $(::<$flag>)? ($($arg),*) };
                }
                if simd.has_avx2() {
                    // SAFETY: as above.
                    return unsafe { avx2 $(::<$flag>)? ($($arg),*) };
                }
            }
            let _ = simd;
            plain::<$crate::step::Plain, $($flag)?>($($arg),*)
        }
    };
}
pub(crate) use for_each_simd;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn the_widest_have_what_the_narrower_have() {
        assert!(Simd(Level::Avx512).has_avx2() && !Simd(Level::Scalar).has_avx2());
    }
}
