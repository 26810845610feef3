//! Text → blocks: variables and expressions, statements, words, and the words of one line by letter and modal group.

mod block;
mod codes;
mod expression;
mod lexer;
mod operators;
mod read;
mod siemens;
mod statement;
mod token;
mod variables;

pub(crate) use block::{Block, Value};
pub(crate) use codes::Code;
pub(crate) use expression::Reader;
pub(crate) use lexer::Lexer;
pub(crate) use siemens::parts;
pub(crate) use statement::{
    Flow, Keyword, ProgramCall, Statement, begins_with_word, is_fanuc_end, line_number, o_word, program_number,
    statement,
};
pub(crate) use token::{Content, Token};
pub(crate) use variables::{Variable, Variables};
