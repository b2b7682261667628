//! The state of a simulation as bytes, and back: a simulation that is restored goes on bit for bit.
//!
//! Numbers are little-endian; a list is its length and its items one after the other, so that an
//! array of numbers is just that; a structure is its fields in order. What is not written is
//! either made anew from what is (the numbering of cells and nodes, the mesh's geometry), or is
//! written by every step before it is read. Structures are taken apart and put together by name of
//! every field, so that none can be forgotten here.

mod simulation;
mod types;
mod values;

pub use simulation::instant;

/// Something that can be written as bytes and read back, equal bit for bit.
pub trait Saved: Sized {
    /// Appends it.
    fn save(&self, out: &mut Vec<u8>);

    /// Takes it from the front.
    ///
    /// # Errors
    ///
    /// If the bytes are not such a thing.
    fn load(from: &mut Bytes) -> Result<Self, Broken>;
}

/// Bytes are not what they should be.
#[derive(Clone, Debug, thiserror::Error, PartialEq)]
#[error("{what} cannot be read")]
pub struct Broken {
    pub what: String,
}

impl Broken {
    pub fn new(what: impl Into<String>) -> Broken {
        Broken { what: what.into() }
    }
}

/// Bytes that are read from the front.
#[derive(Clone, Debug)]
pub struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    pub fn new(bytes: &'a [u8]) -> Bytes<'a> {
        Bytes(bytes)
    }

    /// The next `count` bytes.
    ///
    /// # Errors
    ///
    /// If there are not so many.
    pub fn take(&mut self, count: usize) -> Result<&'a [u8], Broken> {
        let (taken, rest) = (self.0.split_at_checked(count))
            .ok_or_else(|| Broken::new("a value that is cut off"))?;
        self.0 = rest;
        Ok(taken)
    }

    /// Number of bytes that are left.
    pub fn left(&self) -> usize {
        self.0.len()
    }
}

/// All that `bytes` hold, as one thing.
///
/// # Errors
///
/// If they do not, or hold more.
pub fn load<T: Saved>(bytes: &[u8]) -> Result<T, Broken> {
    let mut bytes = Bytes::new(bytes);
    let loaded = T::load(&mut bytes)?;
    match bytes.left() {
        0 => Ok(loaded),
        _ => Err(Broken::new("what follows")),
    }
}

/// Makes a structure [`Saved`], field by field.
#[macro_export]
macro_rules! saved {
    ($name:ident { $($field:ident),* $(,)? }) => {
        impl $crate::saved::Saved for $name {
            fn save(&self, out: &mut Vec<u8>) {
                let $name { $($field),* } = self;
                $($crate::saved::Saved::save($field, out);)*
            }

            fn load(from: &mut $crate::saved::Bytes) -> Result<Self, $crate::saved::Broken> {
                Ok($name { $($field: $crate::saved::Saved::load(from)?),* })
            }
        }
    };
}

/// Makes an enumeration [`Saved`]: a byte that says which, and its fields. Numbers are never given
/// twice, also not to what there is no more.
#[macro_export]
macro_rules! saved_enum {
    ($name:ident { $($number:literal => $variant:ident $( { $($field:ident),* } )? $( ( $($item:ident),* ) )?),* $(,)? }) => {
        impl $crate::saved::Saved for $name {
            fn save(&self, out: &mut Vec<u8>) {
                match self {
                    $($name::$variant $( { $($field),* } )? $( ( $($item),* ) )? => {
                        out.push($number);
                        $($($crate::saved::Saved::save($field, out);)*)?
                        $($($crate::saved::Saved::save($item, out);)*)?
                    })*
                }
            }

            fn load(from: &mut $crate::saved::Bytes) -> Result<Self, $crate::saved::Broken> {
                Ok(match from.take(1)?[0] {
                    $($number => {
                        $($(let $field = $crate::saved::Saved::load(from)?;)*)?
                        $($(let $item = $crate::saved::Saved::load(from)?;)*)?
                        $name::$variant $( { $($field),* } )? $( ( $($item),* ) )?
                    })*
                    _ => return Err($crate::saved::Broken::new(stringify!($name))),
                })
            }
        }
    };
}
