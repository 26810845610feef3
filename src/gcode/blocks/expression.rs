//! Expressions: RS274/NGC section 3.5 with LinuxCNC's additions, and Fanuc's custom macro B.

use super::operators::{FANUC, NGC, Operator, Operator as O, SIEMENS};
use super::variables::{Variable, Variables};
use crate::gcode::dialect::Macros;
use crate::gcode::messages::{DiagnosticKind, Fault};
use crate::gcode::text::{Place, number};

/// Deepest nesting of brackets. No control takes a quarter of it.
const MAX_DEPTH: u32 = 40;
/// LinuxCNC's EQ and NE take numbers this close as equal.
const SAME: f64 = 1e-4;

const FUNCTIONS: &[&[u8]] = &[
    b"SIN", b"COS", b"TAN", b"ASIN", b"ACOS", b"ATAN", b"SQRT", b"ABS", b"ROUND", b"FIX", b"FUP", b"EXP", b"LN",
    b"EXISTS",
];

/// Whether a function begins here.
pub(crate) fn starts_function(text: &[u8]) -> bool {
    if !text.first().is_some_and(u8::is_ascii_alphabetic) {
        return false;
    }
    let name = text.iter().take_while(|b| b.is_ascii_alphabetic()).count();
    let bracket = text.iter().skip(name).find(|b| !b.is_ascii_whitespace()) == Some(&b'[');
    bracket && FUNCTIONS.iter().any(|known| text.get(..name).is_some_and(|name| name.eq_ignore_ascii_case(known)))
}

/// Reads values from a block, left to right. A value that is none is vacant.
#[derive(Debug)]
pub(crate) struct Reader<'a> {
    pub(crate) text: &'a [u8],
    pub(crate) at: usize,
    pub(crate) variables: &'a Variables,
    depth: u32,
}

type Value = Result<Option<f64>, Fault>;

impl<'a> Reader<'a> {
    pub(crate) const fn new(text: &'a [u8], at: usize, variables: &'a Variables) -> Self {
        Self { text, at, variables, depth: 0 }
    }

    pub(crate) fn rest(&self) -> &'a [u8] {
        self.text.get(self.at..).unwrap_or_default()
    }

    pub(crate) fn skip_blanks(&mut self) {
        self.at += self.rest().iter().take_while(|b| b.is_ascii_whitespace()).count();
    }

    /// Steps over a byte, if it comes next.
    pub(crate) fn accept(&mut self, byte: u8) -> bool {
        self.skip_blanks();
        let found = self.rest().first() == Some(&byte);
        self.at += usize::from(found);
        found
    }

    /// Steps over a word, if it comes next, in either case.
    pub(crate) fn accept_word(&mut self, word: &[u8]) -> bool {
        self.skip_blanks();
        let found = self.rest().get(..word.len()).is_some_and(|next| next.eq_ignore_ascii_case(word));
        self.at += if found { word.len() } else { 0 };
        found
    }

    fn fault(&self, kind: DiagnosticKind, start: usize) -> Fault {
        (kind, Place::new(start.min(self.text.len()), self.at.max(start + 1).min(self.text.len())))
    }

    fn bad(&self) -> Fault {
        self.fault(DiagnosticKind::BadExpression, self.at)
    }

    /// A number, a variable, brackets or a function, perhaps with a sign.
    pub(crate) fn value(&mut self) -> Value {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.fault(DiagnosticKind::ExpressionTooDeep { limit: MAX_DEPTH }, self.at));
        }
        let value = self.signed();
        self.depth -= 1;
        value
    }

    fn signed(&mut self) -> Value {
        if self.accept(b'-') {
            return Ok(Some(-self.value()?.unwrap_or(0.0)));
        }
        if self.accept(b'+') {
            return self.value();
        }
        if self.accept(b'#') {
            let start = self.at - 1;
            let variable = self.variable()?;
            return self.variables.read(&variable).map_err(|kind| self.fault(kind, start));
        }
        if self.variables.macros == Macros::Siemens {
            self.skip_blanks();
            if matches!(self.rest(), [b'R' | b'r', b'0'..=b'9', ..]) {
                let start = self.at;
                self.at += 1;
                let variable = self.r_parameter()?;
                return self.variables.read(&variable).map_err(|kind| self.fault(kind, start));
            }
            if self.accept(b'(') {
                let value = self.expression(1)?;
                return if self.accept(b')') { Ok(value) } else { Err(self.bad()) };
            }
        } else if self.accept(b'[') {
            return self.bracketed();
        }
        let digits = self.rest().iter().take_while(|b| b.is_ascii_digit() || **b == b'.').count();
        if digits > 0 {
            let start = self.at;
            self.at += digits;
            let number = self.text.get(start..self.at).and_then(number::parse);
            let number = number.filter(|number| number.value <= number::LARGEST);
            return number
                .map(|number| Some(number.value))
                .ok_or_else(|| self.fault(DiagnosticKind::BadExpression, start));
        }
        if starts_function(self.rest()) { self.function() } else { Err(self.bad()) }
    }

    /// What stands behind `#1 =`: RS274 asks for brackets around a sum, a Fanuc does not.
    pub(crate) fn assigned(&mut self) -> Value {
        if self.variables.macros == Macros::Fanuc { self.expression(1) } else { self.value() }
    }

    /// What stands behind `R`.
    pub(crate) fn r_parameter(&mut self) -> Result<Variable, Fault> {
        let start = self.at;
        self.at += self.rest().iter().take_while(|b| b.is_ascii_digit()).count();
        let number = self.text.get(start..self.at).and_then(number::parse).filter(|number| number.value < 1e6);
        number.map(|number| Variable::Number(number.value as u32)).ok_or_else(|| self.bad())
    }

    /// A sum of a SINUMERIK, which needs no brackets.
    pub(crate) fn sum(&mut self) -> Value {
        self.expression(1)
    }

    /// What stands behind `#`: a number, a name, or what computes to a number.
    pub(crate) fn variable(&mut self) -> Result<Variable, Fault> {
        if self.variables.macros == Macros::Ngc && self.accept(b'<') {
            let name = self.rest();
            let length = name.iter().position(|&b| b == b'>').ok_or_else(|| self.bad())?;
            self.at += length + 1;
            let name = name.iter().take(length).filter(|b| !b.is_ascii_whitespace()).map(u8::to_ascii_lowercase);
            return Ok(Variable::Name(name.collect()));
        }
        let start = self.at;
        let number = self.value()?.unwrap_or(0.0);
        let whole = (number - number.round()).abs() < 1e-3 && (0.0..1e6).contains(&number.round());
        if whole {
            Ok(Variable::Number(number.round() as u32))
        } else {
            Err(self.fault(DiagnosticKind::BadExpression, start))
        }
    }

    /// After `[`: an expression and `]`.
    fn bracketed(&mut self) -> Value {
        let value = self.expression(1)?;
        if self.accept(b']') { Ok(value) } else { Err(self.bad()) }
    }

    /// Operators of at least this rank, from left to right.
    fn expression(&mut self, rank: u32) -> Value {
        let mut left = self.value()?;
        loop {
            self.skip_blanks();
            let start = self.at;
            let table = match self.variables.macros {
                Macros::Fanuc => FANUC,
                Macros::Siemens => SIEMENS,
                Macros::Ngc | Macros::None => NGC,
            };
            let rest = self.rest();
            let begins = |name: &[u8]| rest.get(..name.len()).is_some_and(|next| next.eq_ignore_ascii_case(name));
            let Some(&(name, found, operator)) = table.iter().find(|(name, ..)| begins(name)) else { return Ok(left) };
            if found < rank {
                return Ok(left);
            }
            self.at += name.len();
            let right = self.expression(found + 1)?;
            let value = self.apply(operator, left, right);
            left =
                Some(value.filter(|v| v.is_finite()).ok_or_else(|| self.fault(DiagnosticKind::NotComputable, start))?);
        }
    }

    fn apply(&self, operator: Operator, left: Option<f64>, right: Option<f64>) -> Option<f64> {
        let fanuc = self.variables.macros == Macros::Fanuc;
        let (a, b) = (left.unwrap_or(0.0), right.unwrap_or(0.0));
        let truth = |is: bool| f64::from(u8::from(is));
        // Vacant equals vacant alone.
        let equal = if fanuc { left == right } else { (a - b).abs() < SAME };
        let logic = |bits: fn(i64, i64) -> i64, truths: fn(bool, bool) -> bool| {
            if fanuc { bits(a.round() as i64, b.round() as i64) as f64 } else { truth(truths(a != 0.0, b != 0.0)) }
        };
        Some(match operator {
            O::Power => a.powf(b),
            O::Times => a * b,
            O::Over => (b != 0.0).then_some(a / b)?,
            O::Modulo if fanuc => a % b,
            O::Modulo => a.rem_euclid(b),
            O::Plus => a + b,
            O::Minus => a - b,
            O::Equal => truth(equal),
            O::NotEqual => truth(!equal),
            O::Greater => truth(a > b),
            O::GreaterOrEqual => truth(a >= b),
            O::Less => truth(a < b),
            O::LessOrEqual => truth(a <= b),
            O::And => logic(|a, b| a & b, |a, b| a && b),
            O::Or => logic(|a, b| a | b, |a, b| a || b),
            O::Xor => logic(|a, b| a ^ b, |a, b| a != b),
        })
    }

    fn function(&mut self) -> Value {
        let start = self.at;
        let name = self.rest();
        let length = name.iter().take_while(|b| b.is_ascii_alphabetic()).count();
        let name = name.get(..length).unwrap_or_default().to_ascii_uppercase();
        self.at += length;
        if !self.accept(b'[') {
            return Err(self.bad());
        }
        if name == b"EXISTS" {
            if !self.accept(b'#') {
                return Err(self.bad());
            }
            let variable = self.variable()?;
            let exists = f64::from(u8::from(self.variables.exists(&variable)));
            return if self.accept(b']') { Ok(Some(exists)) } else { Err(self.bad()) };
        }
        let x = self.bracketed()?.unwrap_or(0.0);
        let value = match name.as_slice() {
            b"SIN" => x.to_radians().sin(),
            b"COS" => x.to_radians().cos(),
            b"TAN" => x.to_radians().tan(),
            b"ASIN" => x.asin().to_degrees(),
            b"ACOS" => x.acos().to_degrees(),
            b"ATAN" => return self.arc_tangent(x),
            b"SQRT" => x.sqrt(),
            b"ABS" => x.abs(),
            b"ROUND" => x.round(),
            // FIX of a Fanuc drops the fraction, that of RS274 rounds down.
            b"FIX" if self.variables.macros == Macros::Fanuc => x.trunc(),
            b"FIX" => x.floor(),
            b"FUP" if self.variables.macros == Macros::Fanuc => x.abs().ceil().copysign(x),
            b"FUP" => x.ceil(),
            b"EXP" => x.exp(),
            _ => x.ln(),
        };
        let value = Some(value).filter(|value| value.is_finite());
        value.map(Some).ok_or_else(|| self.fault(DiagnosticKind::NotComputable, start))
    }

    /// ATAN[y]/[x]: all four quadrants, from 0 to 360 on a Fanuc (parameter 6004 bit 0), from −180 to 180 in RS274.
    fn arc_tangent(&mut self, y: f64) -> Value {
        let fanuc = self.variables.macros == Macros::Fanuc;
        if !self.accept(b'/') {
            return if fanuc { Ok(Some(y.atan().to_degrees())) } else { Err(self.bad()) };
        }
        if !self.accept(b'[') {
            return Err(self.bad());
        }
        let x = self.bracketed()?.unwrap_or(0.0);
        let degrees = y.atan2(x).to_degrees();
        Ok(Some(if fanuc && degrees < 0.0 { degrees + 360.0 } else { degrees }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str, macros: Macros) -> Result<Option<f64>, &'static str> {
        let mut variables = Variables::new(macros);
        variables.write(Variable::Number(1), Some(7.0)).unwrap();
        Reader::new(text.as_bytes(), 0, &variables).value().map_err(|(kind, _)| kind.code())
    }

    #[test]
    fn ranks_of_operators() {
        for (text, ngc) in [
            ("[2+3*4]", 14.0),
            ("[2**3**2]", 64.0),
            ("[-3 MOD 5]", 2.0),
            ("[1 + 1 EQ 2 AND 3 GT 2]", 1.0),
            ("[#1 * [1 + 1]]", 14.0),
            ("-#1", -7.0),
            ("ATAN[1]/[-1]", 135.0),
            ("SQRT[9]", 3.0),
            ("FIX[-2.5]", -3.0),
            ("[5 OR 0]", 1.0),
            ("EXISTS[#1]", 1.0),
            ("EXISTS[#<a>]", 0.0),
        ] {
            let found = value(text, Macros::Ngc).unwrap().unwrap();
            assert!((found - ngc).abs() < 1e-12, "{text} is {found}");
        }
        for (text, fanuc) in [
            ("[2+3 AND 1]", 3.0),
            ("[6 OR 1]", 7.0),
            ("FIX[-2.5]", -2.0),
            ("FUP[-2.5]", -3.0),
            ("ATAN[-1]/[-1]", 225.0),
        ] {
            let found = value(text, Macros::Fanuc).unwrap().unwrap();
            assert!((found - fanuc).abs() < 1e-12, "{text} is {found}");
        }
        assert_eq!(value("[#2 EQ #0]", Macros::Fanuc), Ok(Some(1.0)));
        assert_eq!(value("[#2 EQ 0]", Macros::Fanuc), Ok(Some(0.0)));
        assert_eq!(value("#2", Macros::Fanuc), Ok(None));
    }

    #[test]
    fn what_cannot_be_computed() {
        for (text, code) in [
            ("[1/0]", "G119"),
            ("SQRT[-1]", "G119"),
            ("[1", "G116"),
            ("[1 2]", "G116"),
            ("#<a>", "G118"),
            ("#5220", "G117"),
            ("ATAN[1]", "G116"),
            ("FOO[1]", "G116"),
        ] {
            assert_eq!(value(text, Macros::Ngc), Err(code), "{text}");
        }
        assert_eq!(value(&"[".repeat(100_000), Macros::Ngc), Err("G120"));
        assert_eq!(value(&"-".repeat(100_000), Macros::Ngc), Err("G120"));
    }
}
