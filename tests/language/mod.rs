mod budgets;
mod expressions;
mod flow;
mod programs;
mod text;
mod unknown;
mod words;
