//! Numbers in either byte order.

/// Byte order of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Order {
    /// Least significant byte first.
    Little,
    /// Most significant byte first.
    Big,
}

impl Order {
    pub(super) fn u16(self, bytes: [u8; 2]) -> u16 {
        match self {
            Order::Little => u16::from_le_bytes(bytes),
            Order::Big => u16::from_be_bytes(bytes),
        }
    }

    pub(super) fn u32(self, bytes: [u8; 4]) -> u32 {
        match self {
            Order::Little => u32::from_le_bytes(bytes),
            Order::Big => u32::from_be_bytes(bytes),
        }
    }

    fn u64(self, bytes: [u8; 8]) -> u64 {
        match self {
            Order::Little => u64::from_le_bytes(bytes),
            Order::Big => u64::from_be_bytes(bytes),
        }
    }
}

/// Number types of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NumberType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
    I64,
    U64,
}

impl NumberType {
    /// Type with this code, if it is one of a number.
    pub(super) fn of(code: u32) -> Option<NumberType> {
        Some(match code {
            1 => NumberType::I8,
            2 => NumberType::U8,
            3 => NumberType::I16,
            4 => NumberType::U16,
            5 => NumberType::I32,
            6 => NumberType::U32,
            7 => NumberType::F32,
            9 => NumberType::F64,
            12 => NumberType::I64,
            13 => NumberType::U64,
            _ => return None,
        })
    }

    /// Length of a number, byte.
    pub(super) fn length(self) -> usize {
        match self {
            NumberType::I8 | NumberType::U8 => 1,
            NumberType::I16 | NumberType::U16 => 2,
            NumberType::I32 | NumberType::U32 | NumberType::F32 => 4,
            NumberType::F64 | NumberType::I64 | NumberType::U64 => 8,
        }
    }

    /// The number in `bytes`, whose length is that of the type.
    pub(super) fn number(self, bytes: &[u8], order: Order) -> f64 {
        let two = || <[u8; 2]>::try_from(bytes).map_or(0, |bytes| order.u16(bytes));
        let four = || <[u8; 4]>::try_from(bytes).map_or(0, |bytes| order.u32(bytes));
        let eight = || <[u8; 8]>::try_from(bytes).map_or(0, |bytes| order.u64(bytes));
        let one = bytes.first().copied().unwrap_or(0);
        match self {
            NumberType::I8 => f64::from(one.cast_signed()),
            NumberType::U8 => f64::from(one),
            NumberType::I16 => f64::from(two().cast_signed()),
            NumberType::U16 => f64::from(two()),
            NumberType::I32 => f64::from(four().cast_signed()),
            NumberType::U32 => f64::from(four()),
            NumberType::F32 => f64::from(f32::from_bits(four())),
            NumberType::F64 => f64::from_bits(eight()),
            NumberType::I64 => eight().cast_signed() as f64,
            NumberType::U64 => eight() as f64,
        }
    }
}
