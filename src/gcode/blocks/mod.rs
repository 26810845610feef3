//! Text → blocks: variables and expressions, statements, words, and the words of one line by letter and modal group.

mod block;
mod codes;
mod expression;
mod lexer;
mod statement;
mod variables;

pub(crate) use block::{Block, Content, Value};
pub(crate) use codes::Code;
pub(crate) use expression::Reader;
pub(crate) use lexer::{Lexer, Token};
pub(crate) use statement::{
    Flow, Keyword, ProgramCall, Statement, is_fanuc_end, line_number, o_word, program_number, statement,
};
pub(crate) use variables::{Variable, Variables};
