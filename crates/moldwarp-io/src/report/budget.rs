//! How many particles, frames and digits a page of bearable size can hold.

/// What the reader of a page may wish for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wishes {
    /// Particles that are drawn at most; [`MOST_PARTICLES`] if not given.
    pub particles: Option<usize>,
    /// Frames that are shown at most; all if not given.
    pub frames: Option<usize>,
}

/// More are not drawn: they would neither fit into a page nor be drawn fast enough.
pub const MOST_PARTICLES: usize = 200_000;
/// A page has no more bytes than this, 1 MB below the 25 MB at which mail servers refuse a file.
pub const MOST_BYTES: usize = 24_000_000;
/// Frames that are kept at the cost of particles, if nothing is wished.
const FEW_FRAMES: usize = 20;
/// Particles that are kept at the cost of frames.
const FEW_PARTICLES: usize = 50_000;
/// Bits of a number after the leading one, from what is best to what is still good for colours.
pub const BITS: [u32; 3] = [10, 8, 7];

/// How much is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    pub particles: usize,
    pub frames: usize,
    pub bits: u32,
}

/// What a page costs, bytes.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Of a particle in a frame, for each of [`BITS`].
    pub particle: [f64; 3],
    /// Of a frame besides.
    pub frame: f64,
}

/// As much as there is room for, in bytes: digits give way first, then frames down to
/// [`FEW_FRAMES`], then particles down to [`FEW_PARTICLES`], then frames again.
pub fn share(particles: usize, frames: usize, wishes: Wishes, cost: Cost, room: f64) -> Share {
    let mut share = Share {
        particles: particles
            .min(wishes.particles.unwrap_or(MOST_PARTICLES))
            .max(1),
        frames: frames.min(wishes.frames.unwrap_or(frames)).max(1),
        bits: BITS[0],
    };
    let of =
        |s: Share, particle: f64| s.frames as f64 * (s.particles as f64 * particle + cost.frame);
    for (bits, particle) in BITS.into_iter().zip(cost.particle) {
        share.bits = bits;
        if of(share, particle) <= room {
            return share;
        }
    }
    let particle = cost.particle[2];
    let frames_for =
        |particles: usize| (room / (particles as f64 * particle + cost.frame)) as usize;
    let particles_for =
        |frames: usize| ((room / frames as f64 - cost.frame) / particle).max(1.0) as usize;
    let fewest = share.frames.min(FEW_FRAMES);
    if frames_for(share.particles) < fewest && wishes.particles.is_none() {
        let least = share.particles.min(FEW_PARTICLES);
        share.particles = particles_for(fewest).clamp(least, share.particles);
    }
    share.frames = frames_for(share.particles).clamp(1, share.frames);
    if share.frames == 1 {
        share.particles = particles_for(1).min(share.particles);
    }
    share
}

/// So many numbers below `all`, evenly, the first and the last among them.
pub fn evenly(count: usize, all: usize) -> Vec<usize> {
    match count {
        0 => Vec::new(),
        // What there is in the end says most.
        1 => all.checked_sub(1).into_iter().collect(),
        n if n >= all => (0..all).collect(),
        n => (0..n)
            .map(|i| (i * (all - 1) + (n - 1) / 2) / (n - 1))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COST: Cost = Cost {
        particle: [30.0, 26.0, 24.0],
        frame: 1000.0,
    };

    fn share_of(particles: usize, frames: usize, wishes: Wishes) -> Share {
        let share = share(particles, frames, wishes, COST, 22e6);
        let particle = COST.particle[BITS.iter().position(|&b| b == share.bits).unwrap()];
        let bytes = share.frames as f64 * (share.particles as f64 * particle + COST.frame);
        assert!(bytes <= 22e6, "{share:?}");
        share
    }

    #[test]
    fn digits_give_way_first_then_frames_then_particles() {
        let all = |particles, frames| {
            let s = share_of(particles, frames, Wishes::default());
            (s.particles, s.frames, s.bits)
        };
        assert_eq!(all(2_000, 50), (2_000, 50, 10));
        assert_eq!(all(40_000, 20), (40_000, 20, 8));
        assert_eq!(all(40_000, 50), (40_000, 22, 7));
        assert_eq!(all(200_000, 4), (200_000, 4, 8));
        let (particles, frames, bits) = all(1_000_000, 100);
        assert!(
            particles == 50_000 && frames == 18 && bits == 7,
            "{particles} {frames}"
        );
        assert_eq!(all(45_833, 100), (45_833, 19, 7));
    }

    #[test]
    fn wishes_count() {
        let wishes = Wishes {
            particles: Some(200_000),
            frames: None,
        };
        let s = share_of(300_000, 100, wishes);
        assert_eq!((s.particles, s.frames), (200_000, 4));
        let wishes = Wishes {
            particles: Some(3_000_000),
            frames: Some(2),
        };
        let s = share_of(3_000_000, 100, wishes);
        assert!(s.frames == 1 && s.particles > 900_000);
    }

    #[test]
    fn the_first_and_the_last_frame_are_kept() {
        assert_eq!(evenly(3, 10), [0, 5, 9]);
        assert_eq!(evenly(4, 4), [0, 1, 2, 3]);
        assert_eq!(evenly(1, 7), [6]);
        assert_eq!(evenly(5, 2), [0, 1]);
        assert!(evenly(1, 0).is_empty());
        for count in 2..50 {
            let some = evenly(count, 51);
            assert_eq!((some[0], some[count - 1]), (0, 50));
            assert!(some.windows(2).all(|w| w[0] < w[1]));
        }
    }
}
