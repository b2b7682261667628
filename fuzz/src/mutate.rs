//! Files changed at random, each from the number of its case.

/// The generator splitmix64: small, and good enough to choose places in a file.
pub struct Random(u64);

impl Random {
    /// Every case has its own sequence.
    pub fn new(case: u64) -> Random {
        let mut random = Random(case.wrapping_mul(0xd134_2543_de82_ef95));
        random.next();
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`, which is at least 1.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn choose<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

/// Words for numbers and units that readers trip over.
const WORDS: [&str; 24] = [
    "0",
    "-0",
    "1",
    "-1",
    "4",
    "8",
    "0.5",
    "1e-300",
    "1e308",
    "1e999",
    "-1e999",
    "nan",
    "inf",
    "2147483648",
    "4294967296",
    "1000000000000",
    "9223372036854775807",
    "18446744073709551615",
    "\"1 m\"",
    "\"−1 kPa\"",
    "\"1e-9 m²\"",
    "[]",
    "{}",
    "\"\"",
];
const BYTES: &[u8] = b"0 9-.\n$eE\"'[]{}=,#\\\r\t\0\x01\x7f\x80\xc3\xff";
const INTEGERS: [u64; 9] = [
    0,
    1,
    2,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    1_000_000_000_000,
    i64::MAX as u64,
    u64::MAX,
];

/// What cases are made of.
pub struct Seeds {
    /// At least one.
    pub all: Vec<Vec<u8>>,
    /// Those that a reader takes: changes of them reach farther into it.
    pub right: Vec<Vec<u8>>,
}

/// The file of this case: one of the seeds, half of the time one that is right, with a change or a
/// few, never longer than `most`.
pub fn case(number: u64, seeds: &Seeds, most: usize) -> Vec<u8> {
    let mut random = Random::new(number);
    let from = match random.below(2) {
        0 if !seeds.right.is_empty() => &seeds.right,
        _ => &seeds.all,
    };
    let mut bytes = random.choose(from).clone();
    // One change in half of the cases, two in a quarter …
    for _ in 0..1 + random.next().trailing_zeros() {
        match random.below(6) {
            0 => change_bytes(&mut bytes, &mut random),
            1..=3 => {
                let other = random.choose(&seeds.all).clone();
                change_words(&mut bytes, &other, &mut random);
            }
            4 => change_lines(&mut bytes, &mut random),
            _ => splice(&mut bytes, random.choose(&seeds.all).clone(), &mut random),
        }
        bytes.truncate(most);
    }
    bytes
}

fn change_bytes(bytes: &mut Vec<u8>, random: &mut Random) {
    let at = random.below(bytes.len() + 1);
    let there = at < bytes.len();
    match random.below(6) {
        0 if there => bytes[at] = random.below(256) as u8,
        1 if there => bytes[at] ^= 1 << random.below(8),
        2 if there => drop(bytes.remove(at)),
        3 => bytes.truncate(at),
        4 => {
            // An integer of a binary file, in either order of bytes.
            let number = *random.choose(&INTEGERS);
            let (wide, big) = (random.below(2) == 0, random.below(4) == 0);
            let mut field = match big {
                true => number.to_be_bytes(),
                false => number.to_le_bytes(),
            };
            let field = match (wide, big) {
                (true, _) => &mut field[..],
                (false, true) => &mut field[4..],
                (false, false) => &mut field[..4],
            };
            let room = field.len().min(bytes.len() - at);
            bytes[at..at + room].copy_from_slice(&field[..room]);
        }
        _ => bytes.insert(at, *random.choose(BYTES)),
    }
}

/// Ranges of the parts that `is_part` holds for.
fn parts(bytes: &[u8], is_part: impl Fn(u8) -> bool) -> Vec<(usize, usize)> {
    let mut parts = Vec::new();
    let mut begin = None;
    for (at, &b) in bytes.iter().chain(b"\n").enumerate() {
        let inside = is_part(b) && at < bytes.len();
        match (inside, begin) {
            (true, None) => begin = Some(at),
            (false, Some(first)) => {
                parts.push((first, at));
                begin = None;
            }
            _ => {}
        }
    }
    parts
}

/// Puts another word in the place of one: of the file's own, of another file or of [`WORDS`].
fn change_words(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let is_word = |b| !b" \n\r\t=,[]{}".contains(&b);
    let (words, foreign) = (parts(bytes, is_word), parts(other, is_word));
    if words.is_empty() {
        return;
    }
    let &(from, to) = random.choose(&words);
    let word = match random.below(3) {
        0 => random.choose(&WORDS).as_bytes().to_vec(),
        1 if !foreign.is_empty() => {
            let &(from, to) = random.choose(&foreign);
            other[from..to].to_vec()
        }
        _ => {
            let &(from, to) = random.choose(&words);
            bytes[from..to].to_vec()
        }
    };
    bytes.splice(from..to, word);
}

/// Removes a line, repeats it elsewhere, or exchanges it with the next.
fn change_lines(bytes: &mut Vec<u8>, random: &mut Random) {
    let lines = parts(bytes, |b| b != b'\n');
    if lines.is_empty() {
        return;
    }
    let &(from, to) = random.choose(&lines);
    let end = (to + 1).min(bytes.len());
    match random.below(2) {
        0 => drop(bytes.drain(from..end)),
        _ => {
            let line = bytes[from..end].to_vec();
            let &(place, _) = random.choose(&lines);
            bytes.splice(place..place, line);
        }
    }
}

/// Puts whole lines of another file into this one.
fn splice(bytes: &mut Vec<u8>, other: Vec<u8>, random: &mut Random) {
    let (own, foreign) = (parts(bytes, |b| b != b'\n'), parts(&other, |b| b != b'\n'));
    if own.is_empty() || foreign.is_empty() {
        return;
    }
    let first = random.below(foreign.len());
    let last = (first + random.below(8)).min(foreign.len() - 1);
    let mut lines = other[foreign[first].0..foreign[last].1].to_vec();
    lines.push(b'\n');
    let &(place, _) = random.choose(&own);
    bytes.splice(place..place, lines);
}
