//! Particles side by side: how the step uses the processor's vector instructions.
//!
//! A window is up to [`LANES`] neighbouring cells; slot k of it are their k-th particles, one a lane. A
//! cell with many particles takes several lanes. Those
//! with most particles come first, so that the lanes of a slot are the first ones of the window. What
//! a loop needs is copied to arrays of one number a lane; the loop over the lanes is plain scalar code,
//! which the compiler turns into vector instructions. Each lane's arithmetic is that of the scalar code,
//! operation for operation, and sums over lanes are made in the lanes' order, so that results have the same
//! bits with any instruction set.

use std::ops::Range;

/// Lanes of a window.
pub const LANES: usize = 32;

/// A number for each lane.
pub type Lane = [f64; LANES];
/// A symmetric tensor for each lane, component by component.
pub type VoigtLanes = [Lane; 6];

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
        self.0 == Level::Avx2
    }
}

/// Compiles a function once for each instruction set, and calls the one that its first argument asks for.
/// What it calls must be inlined, else it is compiled for the least processor.
macro_rules! for_each_simd {
    ($(#[$doc:meta])* $vis:vis fn $name:ident($($arg:ident: $type:ty),* $(,)?) $body:block) => {
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)]
        $vis fn $name(simd: $crate::lanes::Simd, $($arg: $type),*) {
            #[inline(always)]
            #[allow(clippy::too_many_arguments)]
            fn plain($($arg: $type),*) $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments)]
                fn avx2($($arg: $type),*) {
                    plain($($arg),*);
                }
                #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
                #[allow(clippy::too_many_arguments)]
                fn avx512($($arg: $type),*) {
                    plain($($arg),*);
                }
                if simd.has_avx512() {
                    // SAFETY: `Simd` is made only where the processor has it.
                    return unsafe { avx512($($arg),*) };
                }
                if simd.has_avx2() {
                    // SAFETY: as above.
                    return unsafe { avx2($($arg),*) };
                }
            }
            let _ = simd;
            plain($($arg),*);
        }
    };
}
pub(crate) use for_each_simd;

/// Items one after another, as many at a time as there are lanes.
pub fn side_by_side(items: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let starts = items.clone().step_by(LANES);
    starts.map(move |start| start..(start + LANES).min(items.end))
}

/// Cells side by side; one with many particles takes several lanes.
#[derive(Clone, Debug)]
pub struct Window {
    /// First particle in each lane, and how many it has.
    first: [u32; LANES],
    count: [u32; LANES],
    cell: [u32; LANES],
    lanes: usize,
}

/// Most particles of a lane.
const DEEP: u32 = 8;

impl Window {
    /// Lanes one after another, brought into order: those with most particles first.
    fn sorted(first: &[u32], count: &[u32], cell: &[u32]) -> Window {
        let mut window = Window {
            first: [0; LANES],
            count: [0; LANES],
            cell: [0; LANES],
            lanes: first.len(),
        };
        let mut start = [0u8; DEEP as usize + 2];
        for &count in count {
            start[(DEEP - count) as usize + 1] += 1;
        }
        for k in 0..=DEEP as usize {
            start[k + 1] += start[k];
        }
        for i in 0..first.len() {
            let place = &mut start[(DEEP - count[i]) as usize];
            let lane = usize::from(*place);
            *place += 1;
            window.first[lane] = first[i];
            window.count[lane] = count[i];
            window.cell[lane] = cell[i];
        }
        window
    }

    /// Cell in each lane.
    #[inline]
    pub fn cells(&self) -> &[u32] {
        &self.cell[..self.lanes]
    }

    /// The windows of a block of cells. Cells without particles are in none.
    pub fn of(cells: Range<usize>, offsets: &[u32]) -> impl Iterator<Item = Window> {
        let mut c = cells.start;
        let mut next = offsets[c];
        std::iter::from_fn(move || {
            let (mut first, mut count, mut cell) = ([0; LANES], [0; LANES], [0; LANES]);
            let mut lanes = 0;
            while lanes < LANES && c < cells.end {
                let left = offsets[c + 1] - next;
                if left > 0 {
                    (first[lanes], cell[lanes]) = (next, c as u32);
                    count[lanes] = left.min(DEEP);
                    next += count[lanes];
                    lanes += 1;
                }
                if next == offsets[c + 1] {
                    c += 1;
                }
            }
            let window = || Window::sorted(&first[..lanes], &count[..lanes], &cell[..lanes]);
            (lanes > 0).then(window)
        })
    }

    /// Slots one after another: the particle in each of their lanes.
    #[inline]
    pub fn slots(&self, mut each: impl FnMut(&[u32])) {
        let mut particles = self.first;
        let mut lanes = self.lanes;
        for k in 0.. {
            while lanes > 0 && self.count[lanes - 1] <= k {
                lanes -= 1;
            }
            if lanes == 0 {
                return;
            }
            each(&particles[..lanes]);
            particles[..lanes].iter_mut().for_each(|p| *p += 1);
        }
    }
}

/// Lanes that a loop works on to have so many: vector instructions do eight at a time, and what is left over
/// would be done one by one. What the additional ones hold is a number from before, and goes nowhere.
#[inline(always)]
pub fn whole(lanes: usize) -> usize {
    // Written so that the compiler sees that it is a multiple of eight and no more than there are.
    lanes.div_ceil(8).min(LANES / 8) * 8
}

/// The number of each component in a lane.
#[inline(always)]
pub fn get<const N: usize>(lanes: &[Lane; N], l: usize) -> [f64; N] {
    std::array::from_fn(|k| lanes[k][l])
}

/// The reverse of [`get`].
#[inline(always)]
pub fn set<const N: usize>(lanes: &mut [Lane; N], l: usize, values: [f64; N]) {
    for k in 0..N {
        lanes[k][l] = values[k];
    }
}

/// `a` if the condition holds, else `b`. Unlike an `if`, it never becomes a jump, which would keep a loop
/// over lanes scalar.
#[inline(always)]
pub fn either<T>(condition: bool, a: T, b: T) -> T {
    std::hint::select_unpredictable(condition, a, b)
}

/// Σ over the lanes, in their order.
pub fn sum(lanes: &Lane) -> f64 {
    lanes.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_particle_comes_once_in_its_cells_lane() {
        let counts = [0, 3, 1, 400, 0, 33, 4, 4, 0, 8, 9, 2, 0];
        let mut offsets = vec![5];
        for n in counts {
            offsets.push(offsets.last().unwrap() + n);
        }
        let mut seen = vec![0; *offsets.last().unwrap() as usize];
        for window in Window::of(0..counts.len(), &offsets) {
            assert!(window.cells().len() <= LANES);
            window.slots(|particles| {
                for (&p, &c) in particles.iter().zip(window.cells()) {
                    assert!((offsets[c as usize]..offsets[c as usize + 1]).contains(&p));
                    seen[p as usize] += 1;
                }
            });
        }
        assert!(seen[..5].iter().all(|&n| n == 0) && seen[5..].iter().all(|&n| n == 1));
    }
}
