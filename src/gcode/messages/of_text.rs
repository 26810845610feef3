//! Words about characters, numbers and expressions.

use super::kind::{DiagnosticKind as K, Found};
use super::letter::Letter;

/// Message and hint of a finding in characters, numbers or expressions; none of any other finding.
pub(super) fn words(kind: &K) -> Option<(String, String)> {
    let (message, hint): (String, &str) = match *kind {
        K::UnexpectedCharacter { found: Found::Character(')') } => {
            ("')' closes no comment".into(), "a comment ends at its first ')': comments do not nest")
        }
        K::UnexpectedCharacter { found: Found::Character(dash @ ('\u{2010}'..='\u{2015}' | '\u{2212}')) } => {
            (format!("'{dash}' is a dash of another kind than minus"), "type '-' in its place")
        }
        K::UnexpectedCharacter { found } => (
            format!("{found} has no meaning in G-code"),
            "a block is made of words such as X12.5; text goes in a comment, ( ) or ;",
        ),
        K::MissingNumber { letter } => {
            (format!("{} has no number", Letter(letter)), "write its number right after it, as in X12.5")
        }
        K::MalformedNumber { letter } => (
            format!("the number after {} cannot be read", Letter(letter)),
            "a number has at most one sign, in front, and one point: -12.5",
        ),
        K::NumberTooLarge { letter } => {
            (format!("the number after {} is too large", Letter(letter)), "no word carries more than 1000000000")
        }
        K::ExponentNotation { letter } => (
            format!("the number after {} has an exponent", Letter(letter)),
            "G-code has no exponents: write all digits, 1500 for 1.5e3",
        ),
        K::NotANumber { letter } => (
            format!("{} is followed by a word in place of a number", Letter(letter)),
            "a post processor writes this where a calculation failed: look there",
        ),
        K::NumberWithoutLetter => (
            "this number belongs to no letter".into(),
            "put its letter in front; a number has no blanks inside, X10 and not X1 0",
        ),
        K::TextOutsideComment => (
            "these letters are no words of G-code".into(),
            "put text in a comment, ( ) or ; (statements such as IF and GOTO are not read)",
        ),
        K::UnclosedComment => ("this comment does not end".into(), "close it with ')' on the same line"),
        K::Expression => (
            "variables and expressions are not read here".into(),
            "write the value itself, X12.5; the rest of the block was skipped",
        ),
        K::BlockDeleteNotFirst => (
            "'/' stands inside the block".into(),
            "block delete is the first character of a block; a comment begins with '//'",
        ),
        K::PercentNotAlone => {
            ("'%' shares its line with words".into(), "put '%' on a line of its own, first and last of the program")
        }
        K::BlockTooLong { limit } => (
            format!("this block has more than {limit} bytes"),
            "this is not a G-code program, or its line ends are lost: one block on each line",
        ),
        K::NotText => (
            "this file is not plain text: it holds a zero byte".into(),
            "save the program as ASCII or UTF-8 text; nothing after this was read",
        ),
        K::JumpInStream => (
            "a jump needs the program's other lines, and this one is read line by line".into(),
            "give the program as a file",
        ),
        K::BadExpression => (
            "this expression cannot be read".into(),
            "values are numbers, #1, [1 + 2] and SIN[30]; every bracket has its partner",
        ),
        K::UnknownVariable { number } => (
            format!("#{number} is not known here"),
            "fanuc and haas have #1 to #33, #100 to #199, #500 to #999 and the position #5001, #5021, #5041; linuxcnc #1 to #5000 and #5420",
        ),
        K::ReadBehindWrite => (
            "this parameter is written here and read further on in the block: it is not known which value is meant"
                .into(),
            "write it in a block before",
        ),
        K::UnknownName => ("this name was never given a value".into(), "assign it first: #<depth> = 12"),
        K::NotComputable => (
            "this has no value".into(),
            "a division by zero, the root of a negative number, or a result that is too large",
        ),
        K::ExpressionTooDeep { limit } => {
            return Some((
                "this expression is nested too deep".into(),
                format!("at most {limit} levels: compute parts before"),
            ));
        }
        K::UnknownStatement => (
            "this statement cannot be read".into(),
            "fanuc: IF [ ] GOTO n, IF [ ] THEN #1 = 2, WHILE [ ] DO 1, END 1, GOTO n; linuxcnc: o1 if [ ], o1 while [ ], o1 call",
        ),
        K::TextBehindEndOfBlock => (
            "this stands behind ';', which ends the block on this control".into(),
            "put each block on a line of its own, and a comment in ( )",
        ),
        K::ExtendedAddress { letter } => (
            format!("{} of another spindle or axis is not read", Letter(letter)),
            "there is one spindle: S=500 or S1=500, M3 or M1=3",
        ),
        _ => return None,
    };
    Some((message, hint.into()))
}
