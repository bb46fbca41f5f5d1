//! A formula in one variable, read from text and kept as postfix operations: evaluating it gives value
//! and derivatives without allocating.
//!
//! Grammar, loosest first; `^` binds tighter than a sign before it (−t^2 = −(t²)) and groups to the right:
//!
//! ```text
//! comparison = sum [("<" | "<=" | ">" | ">=") sum]       1 where true, 0 elsewhere
//! sum        = product {("+" | "-") product}
//! product    = signed {("*" | "/") signed}
//! signed     = ("+" | "-") signed | atom ["^" signed]
//! atom       = number | name | name "(" comparison {"," comparison} ")" | "(" comparison ")"
//! ```

use super::ProfileError;
use super::interval::Interval;
use super::jet::Jet;
use super::number::{Function, Number};

/// Most values that may wait on the stack.
const DEPTH: usize = 48;

#[derive(Clone, Copy, Debug)]
enum Op {
    Number(f64),
    Variable,
    Smooth(Function),
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    /// a < b, or a ≤ b.
    Less {
        or_equal: bool,
    },
    Swap,
    Abs,
    Sign,
    Step,
    Floor,
    Min,
    Max,
    If,
}

impl Op {
    /// Number of values it takes from the stack.
    fn arguments(&self) -> usize {
        match self {
            Op::Number(_) | Op::Variable => 0,
            Op::If => 3,
            Op::Smooth(_) | Op::Neg | Op::Abs | Op::Sign | Op::Step | Op::Floor => 1,
            _ => 2,
        }
    }
}

/// The operations with those on numbers alone carried out.
fn folded(ops: Vec<Op>) -> Vec<Op> {
    let mut out: Vec<Op> = Vec::with_capacity(ops.len());
    for op in ops {
        let arguments = op.arguments();
        out.push(op);
        let first = out.len() - 1 - arguments;
        let constant = out[first..first + arguments].iter().all(|a| matches!(a, Op::Number(_)));
        if arguments > 0 && constant && !matches!(op, Op::Swap) {
            let value = Program { ops: out.split_off(first) }.value(0.0);
            out.push(Op::Number(value));
        }
    }
    out
}

const CONSTANTS: [(&str, f64); 3] =
    [("pi", std::f64::consts::PI), ("tau", std::f64::consts::TAU), ("e", std::f64::consts::E)];

/// Name, number of arguments, operation.
const FUNCTIONS: [(&str, usize, Op); 20] = [
    ("sin", 1, Op::Smooth(Function::Sin)),
    ("cos", 1, Op::Smooth(Function::Cos)),
    ("tan", 1, Op::Smooth(Function::Tan)),
    ("asin", 1, Op::Smooth(Function::Asin)),
    ("acos", 1, Op::Smooth(Function::Acos)),
    ("atan", 1, Op::Smooth(Function::Atan)),
    ("sinh", 1, Op::Smooth(Function::Sinh)),
    ("cosh", 1, Op::Smooth(Function::Cosh)),
    ("tanh", 1, Op::Smooth(Function::Tanh)),
    ("exp", 1, Op::Smooth(Function::Exp)),
    ("ln", 1, Op::Smooth(Function::Ln)),
    ("log10", 1, Op::Smooth(Function::Log10)),
    ("sqrt", 1, Op::Smooth(Function::Sqrt)),
    ("abs", 1, Op::Abs),
    ("sign", 1, Op::Sign),
    ("step", 1, Op::Step),
    ("floor", 1, Op::Floor),
    ("min", 2, Op::Min),
    ("max", 2, Op::Max),
    ("if", 3, Op::If),
];

/// A formula ready to be evaluated.
#[derive(Clone, Debug)]
pub(super) struct Program {
    ops: Vec<Op>,
}

impl Program {
    /// Reads `text` as a formula in `variable`.
    pub fn parse(text: &str, variable: &str) -> Result<Program, ProfileError> {
        let mut parser = Parser { text, variable, at: 0, nesting: 0, ops: Vec::new() };
        let read = parser.comparison().and_then(|()| match parser.peek() {
            None => Ok(()),
            Some(c) => Err(format!("`{c}` does not continue the formula")),
        });
        let program = Program { ops: parser.ops };
        let fault = match read {
            Ok(()) if program.depth() > DEPTH => {
                format!("more than {DEPTH} values wait on each other; split it")
            }
            Ok(()) => return Ok(Program { ops: folded(program.ops) }),
            Err(fault) => fault,
        };
        Err(ProfileError::Expression { text: text.into(), offset: parser.at, fault })
    }

    /// Most values on the stack at once.
    fn depth(&self) -> usize {
        let (mut now, mut most) = (0_usize, 0);
        for op in &self.ops {
            now = match op {
                Op::Number(_) | Op::Variable => now + 1,
                Op::If => now.saturating_sub(2),
                Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Pow | Op::Less { .. } | Op::Min | Op::Max => {
                    now.saturating_sub(1)
                }
                _ => now,
            };
            most = most.max(now);
        }
        most
    }

    /// Value at `x`.
    pub fn value(&self, x: f64) -> f64 {
        self.run(x, |_| {})
    }

    /// Value and derivatives at `x`, and a number that changes when any comparison, sign, floor, minimum
    /// or maximum is decided differently.
    pub fn eval(&self, x: f64) -> (Jet, u64) {
        let mut branch = 0xcbf2_9ce4_8422_2325_u64;
        let jet = self.run(Jet::variable(x), |what| {
            branch = (branch ^ what.unwrap_or_default()).wrapping_mul(0x0000_0100_0000_01b3);
        });
        (jet, branch)
    }

    /// Bounds of the values from `low` to `high`, and whether every comparison is decided in one way there.
    pub fn bounds(&self, low: f64, high: f64) -> (Interval, bool) {
        let mut decided = true;
        let bounds = self.run(Interval { low, high }, |what| decided &= what.is_some());
        (bounds, decided)
    }

    fn run<N: Number>(&self, x: N, mut decide: impl FnMut(Option<u64>)) -> N {
        let mut stack = [N::default(); DEPTH];
        let mut top = 0_usize;
        let constant = N::constant;
        for op in &self.ops {
            let base = top - op.arguments();
            let a = stack[base];
            let b = stack[(base + 1).min(DEPTH - 1)];
            let is_negative = || a.below(constant(0.0), false);
            let mut choose = |holds: Option<bool>, yes: N, no: N| {
                decide(holds.map(u64::from));
                match holds {
                    Some(true) => yes,
                    Some(false) => no,
                    None => yes.or(no),
                }
            };
            let result = match *op {
                Op::Number(value) => constant(value),
                Op::Variable => x,
                Op::Smooth(function) => a.apply(function),
                Op::Neg => -a,
                Op::Add => a + b,
                Op::Sub => a - b,
                Op::Mul => a * b,
                Op::Div => a / b,
                Op::Pow => a.pow(b),
                Op::Swap => {
                    (stack[base], stack[base + 1]) = (b, a);
                    continue;
                }
                Op::Less { or_equal } => choose(a.below(b, or_equal), constant(1.0), constant(0.0)),
                Op::Abs => choose(is_negative(), -a, a),
                Op::Sign => choose(is_negative(), constant(-1.0), constant(1.0)),
                Op::Step => choose(is_negative(), constant(0.0), constant(1.0)),
                Op::Floor => {
                    let (whole, number) = a.floor();
                    decide(number.map(f64::to_bits));
                    whole
                }
                Op::Min => choose(b.below(a, false), b, a),
                Op::Max => choose(a.below(b, false), b, a),
                Op::If => choose(a.differs_from_zero(), b, stack[base + 2]),
            };
            stack[base] = result;
            top = base + 1;
        }
        stack[0]
    }
}

struct Parser<'a> {
    text: &'a str,
    variable: &'a str,
    at: usize,
    nesting: usize,
    ops: Vec<Op>,
}

type Read = Result<(), String>;

impl Parser<'_> {
    /// The next character that is not blank; `at` is left on it.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn take(&mut self, token: &str) -> bool {
        self.peek();
        let found = self.text[self.at..].starts_with(token);
        self.at += if found { token.len() } else { 0 };
        found
    }

    fn comparison(&mut self) -> Read {
        self.sum()?;
        for (token, swap, or_equal) in
            [("<=", false, true), (">=", true, true), ("<", false, false), (">", true, false)]
        {
            if self.take(token) {
                self.sum()?;
                if swap {
                    self.ops.push(Op::Swap);
                }
                self.ops.push(Op::Less { or_equal });
                break;
            }
        }
        Ok(())
    }

    fn sum(&mut self) -> Read {
        self.product()?;
        loop {
            let op = if self.take("+") {
                Op::Add
            } else if self.take("-") {
                Op::Sub
            } else {
                return Ok(());
            };
            self.product()?;
            self.ops.push(op);
        }
    }

    fn product(&mut self) -> Read {
        self.signed()?;
        loop {
            let op = if self.take("*") {
                Op::Mul
            } else if self.take("/") {
                Op::Div
            } else {
                return Ok(());
            };
            self.signed()?;
            self.ops.push(op);
        }
    }

    fn signed(&mut self) -> Read {
        self.nesting += 1;
        if self.nesting > 200 {
            return Err("brackets or signs are nested more than 200 deep".into());
        }
        if self.take("-") {
            self.signed()?;
            self.ops.push(Op::Neg);
        } else if self.take("+") {
            self.signed()?;
        } else {
            self.atom()?;
            if self.take("^") {
                self.signed()?;
                self.ops.push(Op::Pow);
            }
        }
        self.nesting -= 1;
        Ok(())
    }

    fn atom(&mut self) -> Read {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                self.comparison()?;
                self.close()
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            Some('*') => Err("a number or a name is missing before `*`; powers are written with `^`".into()),
            Some(c) => Err(format!("a number, a name or `(` is missing before `{c}`")),
            None => Err("a number, a name or `(` is missing at the end".into()),
        }
    }

    fn close(&mut self) -> Read {
        if self.take(")") { Ok(()) } else { Err("a closing `)` is missing".into()) }
    }

    fn number(&mut self) -> Read {
        let rest = &self.text[self.at..];
        let digits = |from: usize| rest[from..].bytes().take_while(u8::is_ascii_digit).count();
        let mut end = digits(0);
        if rest[end..].starts_with('.') {
            end += 1 + digits(end + 1);
        }
        if rest[end..].starts_with(['e', 'E']) {
            let sign = usize::from(rest[end + 1..].starts_with(['+', '-']));
            let exponent = digits(end + 1 + sign);
            end += if exponent > 0 { 1 + sign + exponent } else { 0 };
        }
        let value = rest[..end].parse::<f64>().ok().filter(|value| value.is_finite());
        let value = value.ok_or_else(|| format!("`{}` is not a finite number", &rest[..end]))?;
        self.at += end;
        self.ops.push(Op::Number(value));
        Ok(())
    }

    fn name(&mut self) -> Read {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
        let name = &rest[..end];
        if name == self.variable {
            self.ops.push(Op::Variable);
        } else if let Some((_, value)) = CONSTANTS.iter().find(|(known, _)| *known == name) {
            self.ops.push(Op::Number(*value));
        } else if let Some(&(_, arguments, op)) = FUNCTIONS.iter().find(|(known, ..)| *known == name) {
            self.at += end;
            if !self.take("(") {
                return Err(format!("`{name}` is a function and needs its argument in `( )`"));
            }
            for i in 0..arguments {
                if i > 0 && !self.take(",") {
                    return Err(format!("`{name}` takes {arguments} arguments, separated by `,`"));
                }
                self.comparison()?;
            }
            self.close()?;
            self.ops.push(op);
            return Ok(());
        } else {
            let known: Vec<&str> = std::iter::once(self.variable)
                .chain(CONSTANTS.iter().map(|c| c.0))
                .chain(FUNCTIONS.iter().map(|f| f.0))
                .collect();
            return Err(format!("`{name}` is not known; the names are {}", known.join(", ")));
        }
        self.at += end;
        Ok(())
    }
}
