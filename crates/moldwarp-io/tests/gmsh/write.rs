//! The literals' mesh in binary, in either order of bytes.

/// Bytes of a binary file.
pub struct Binary {
    pub bytes: Vec<u8>,
    big_endian: bool,
}

macro_rules! put {
    ($self:ident, $value:expr) => {
        if $self.big_endian {
            $self.bytes.extend($value.to_be_bytes())
        } else {
            $self.bytes.extend($value.to_le_bytes())
        }
    };
}

impl Binary {
    fn new(version: &str, big_endian: bool) -> Binary {
        let bytes = Vec::new();
        let mut file = Binary { bytes, big_endian };
        file.text("$MeshFormat\n").text(version).text(" 1 8\n");
        file.ints(&[1]).text("\n$EndMeshFormat\n");
        file.text("$PhysicalNames\n2\n3 1 \"soil\"\n2 5 \"the base\"\n$EndPhysicalNames\n");
        file
    }

    fn text(&mut self, text: &str) -> &mut Binary {
        self.bytes.extend(text.as_bytes());
        self
    }

    fn ints(&mut self, values: &[i32]) -> &mut Binary {
        values.iter().for_each(|v| put!(self, v));
        self
    }

    fn sizes(&mut self, values: &[u64]) -> &mut Binary {
        values.iter().for_each(|v| put!(self, v));
        self
    }

    fn reals(&mut self, values: &[f64]) -> &mut Binary {
        values.iter().for_each(|v| put!(self, v));
        self
    }
}

/// [`V22`](super::V22) in binary.
pub fn v22(big_endian: bool) -> Vec<u8> {
    let mut file = Binary::new("2.2", big_endian);
    file.text("$Nodes\n5\n");
    file.ints(&[40]).reals(&[0.0, 0.0, 1.0]);
    file.ints(&[10]).reals(&[0.0, 0.0, 0.0]);
    file.ints(&[99]).reals(&[7.0, 7.0, 7.0]);
    file.ints(&[30]).reals(&[0.0, 1.0, 0.0]);
    file.ints(&[20]).reals(&[1.0, 0.0, 0.0]);
    file.text("\n$EndNodes\n$Elements\n4\n");
    file.ints(&[15, 1, 2, 1, 0, 1, 10]);
    file.ints(&[1, 1, 2, 2, 0, 1, 10, 20]);
    file.ints(&[2, 1, 2, 3, 5, 1, 10, 30, 20]);
    file.ints(&[4, 1, 2, 8, 1, 1, 10, 20, 30, 40]);
    file.text("\n$EndElements\n");
    file.bytes
}

/// [`V41`](super::V41) in binary.
pub fn v41(big_endian: bool) -> Vec<u8> {
    let mut file = Binary::new("4.1", big_endian);
    file.text("$Entities\n").sizes(&[1, 0, 1, 1]);
    file.ints(&[1]).reals(&[0.0; 3]).sizes(&[0]);
    file.ints(&[1]).reals(&[0.0; 6]).sizes(&[1]).ints(&[-5]);
    file.sizes(&[0]);
    file.ints(&[1]).reals(&[0.0; 6]).sizes(&[1]).ints(&[1]);
    file.sizes(&[1]).ints(&[-1]);
    file.text("\n$EndEntities\n$Nodes\n").sizes(&[2, 5, 10, 99]);
    file.ints(&[0, 1, 0])
        .sizes(&[1, 40])
        .reals(&[0.0, 0.0, 1.0]);
    file.ints(&[2, 1, 1]).sizes(&[4, 10, 99, 30, 20]);
    file.reals(&[0.0; 5]).reals(&[7.0, 7.0, 7.0, 0.0, 0.0]);
    file.reals(&[0.0, 1.0, 0.0, 0.0, 1.0]);
    file.reals(&[1.0, 0.0, 0.0, 1.0, 0.0]);
    file.text("\n$EndNodes\n$Elements\n").sizes(&[3, 3, 1, 8]);
    file.ints(&[0, 1, 15]).sizes(&[1, 1, 10]);
    file.ints(&[2, 1, 2]).sizes(&[1, 3, 10, 30, 20]);
    file.ints(&[3, 1, 4]).sizes(&[1, 8, 10, 20, 30, 40]);
    file.text("\n$EndElements\n");
    file.bytes
}
