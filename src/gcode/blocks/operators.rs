//! Operators of expressions and their ranks, control by control.

/// What an operator does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operator {
    Power,
    Times,
    Over,
    Modulo,
    Plus,
    Minus,
    Equal,
    NotEqual,
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    And,
    Or,
    Xor,
}

use Operator as O;

/// Operators with their rank; the higher binds first. Longer spellings stand before those they begin with.
pub(super) const NGC: &[(&[u8], u32, Operator)] = &[
    (b"**", 5, O::Power),
    (b"*", 4, O::Times),
    (b"/", 4, O::Over),
    (b"MOD", 4, O::Modulo),
    (b"+", 3, O::Plus),
    (b"-", 3, O::Minus),
    (b"EQ", 2, O::Equal),
    (b"NE", 2, O::NotEqual),
    (b"GT", 2, O::Greater),
    (b"GE", 2, O::GreaterOrEqual),
    (b"LT", 2, O::Less),
    (b"LE", 2, O::LessOrEqual),
    (b"AND", 1, O::And),
    (b"OR", 1, O::Or),
    (b"XOR", 1, O::Xor),
];

/// On a Fanuc AND ranks with the products, OR and XOR with the sums, and all three act on bits.
pub(super) const FANUC: &[(&[u8], u32, Operator)] = &[
    (b"*", 3, O::Times),
    (b"/", 3, O::Over),
    (b"MOD", 3, O::Modulo),
    (b"AND", 3, O::And),
    (b"+", 2, O::Plus),
    (b"-", 2, O::Minus),
    (b"OR", 2, O::Or),
    (b"XOR", 2, O::Xor),
    (b"EQ", 1, O::Equal),
    (b"NE", 1, O::NotEqual),
    (b"GT", 1, O::Greater),
    (b"GE", 1, O::GreaterOrEqual),
    (b"LT", 1, O::Less),
    (b"LE", 1, O::LessOrEqual),
];

/// A SINUMERIK's, of which parameters and coordinates need no more.
pub(super) const SIEMENS: &[(&[u8], u32, Operator)] =
    &[(b"*", 2, O::Times), (b"/", 2, O::Over), (b"MOD", 2, O::Modulo), (b"+", 1, O::Plus), (b"-", 1, O::Minus)];
