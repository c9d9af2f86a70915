mod budgets;
mod comp;
mod flow;
mod known_words;
mod programs;
mod readings;
mod text;
mod verdicts;
