//! Damaged files: whatever the bytes, an error and no panic.

use super::{V22, V41, parse, refusal, write};

fn samples() -> [Vec<u8>; 6] {
    [
        V22.as_bytes().to_vec(),
        V41.as_bytes().to_vec(),
        write::v22(false),
        write::v41(false),
        write::v22(true),
        write::v41(true),
    ]
}

#[test]
fn a_file_cut_short_anywhere_is_refused() {
    for (i, bytes) in samples().iter().enumerate() {
        // Without the last line's end, it is whole.
        for length in 0..bytes.len() - 1 {
            let read = parse(&bytes[..length]);
            assert!(read.is_err(), "sample {i} of {length} bytes was read");
        }
    }
}

#[test]
fn changed_bytes_never_panic() {
    // A linear congruential generator; its upper bits are random enough.
    let mut state: u64 = 1;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    let favourites = b"0 9-.\n$e\xff\x7f\x80";
    for bytes in samples() {
        for _ in 0..10_000 {
            let mut damaged = bytes.clone();
            for _ in 0..1 + random(3) {
                let at = random(damaged.len());
                match random(4) {
                    0 => damaged[at] = random(256) as u8,
                    1 => damaged[at] = favourites[random(favourites.len())],
                    2 => damaged.insert(at, favourites[random(favourites.len())]),
                    _ => drop(damaged.remove(at)),
                }
            }
            if let Ok(file) = parse(&damaged) {
                // What passes must be sound enough for the mesh to judge.
                let _ = moldwarp::mesh::Mesh::new(file.raw);
            }
        }
    }
}

#[test]
fn huge_counts_are_refused_at_once() {
    let many = 1_000_000_000_000u64;
    assert_eq!(
        refusal(V22.replace("$Nodes\n5", &format!("$Nodes\n{many}"))),
        "mesh.msh, line 10: the file claims 1000000000000 nodes, but only 151 bytes follow; it \
         may be cut short: copy it again or mesh it again"
    );
    assert_eq!(
        refusal(V22.replace("$Elements\n4", &format!("$Elements\n{many}"))),
        "mesh.msh, line 18: the file claims 1000000000000 elements, but only 84 bytes follow; it \
         may be cut short: copy it again or mesh it again"
    );
    assert_eq!(
        refusal(V41.replace("2 5 10 99", &format!("2 {many} 10 99"))),
        "mesh.msh, line 16: the file claims 1000000000000 nodes, but only 180 bytes follow; it \
         may be cut short: copy it again or mesh it again"
    );
    let mut bytes = write::v41(false);
    let at = bytes.windows(8).position(|w| w == b"\n$Nodes\n").unwrap() + 8;
    bytes[at + 8..at + 16].copy_from_slice(&many.to_le_bytes());
    assert_eq!(
        refusal(bytes),
        "mesh.msh, byte 356: the file claims 1000000000000 nodes, but only 495 bytes follow; it \
         may be cut short: copy it again or mesh it again"
    );
}

#[test]
fn garbage_is_refused() {
    for bytes in [
        &b""[..],
        b"\n\n",
        b"\0\0\0\0",
        b"\xff\xfe$MeshFormat",
        b"$",
        b"$\n",
    ] {
        let message = parse(bytes).unwrap_err();
        assert!(message.contains("a Gmsh mesh begins with"), "{message}");
    }
}
