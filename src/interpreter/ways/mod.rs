//! Ways through a program: what the dry run knows where only the machine decides (chapter 14 of the rules).
//!
//! ```text
//! N10 $WHILE V.E.PARTS > 0
//! N20   $IF V.E.MATERIAL == 2
//! N30     X[COMP OFF FRICT]
//! N40   $ENDIF
//! N50 $ENDWHILE
//! N60 M30
//! ```
//!
//! A way is a state of the control, the answers of the machine that lead to it, and the block at which it waits. One step
//! executes a block on one way. The way whose block comes first in the text is always executed next, so a block is
//! executed once for all ways that lead to it.
//!
//! **What happens at an unknown `$IF`?** At N20 the run parts: one way goes on at N30 with the answer `V.E.MATERIAL == 2`,
//! the other one waits at N40 with the opposite answer. A question is a place in the text with the value that decides
//! ([`question`]); asked again, it may have another answer. An answer that contradicts an earlier one holds only if the
//! value changes in between ([`question`]).
//!
//! **What is printed where ways meet?** At N40 both ways are at the same block of the same call: they are joined. A value
//! that differs becomes unknown. The compensation of X keeps both states, each with the set of answers that lead to it
//! ([`set`]): it is `inactive if V.E.MATERIAL == 2 (line 2), else active` ([`words`]). The history of each kind of
//! compensation also tells on which ways it is still as the program found it, and which commands were the last ones
//! ([`history`]). Where nothing differs, nothing is printed. Sets that grow too large lose conditions: they become wider,
//! never wrong.
//!
//! **When does a loop stop?** N10 asks in every pass, and the way that leaves the loop waits at N60. The states in which
//! passes begin are joined at N10, from the second pass on; a pass that adds nothing is not executed. The joined state is
//! kept while a loop around this one is repeated, so that loops in one another do not multiply their passes. A loop whose
//! own condition is known is executed pass by pass.
//!
//! A call continues each way in its own context: the blocks to which the calls return. Calls multiply their ways; once a
//! quarter of the budget of ways is used, a program that was called before is executed only in states that are new to it,
//! and what it left otherwise is taken over. Past the budget all ways are joined, and what they may change is unknown.
//!
//! **What if only one way may be seen?** Motions and the debugger follow one way. The others are its shadows: they are
//! executed up to the block where the sides of the question meet, and raise no event. What no way can execute, such as
//! the passes of a loop beyond its budget, is passed over: its text is read, and what it names is unknown.
//!
//! What a way consists of is in [`path`], those that wait, the heads of loops and the effects of calls are in
//! [`others`]. Where ways part, meet and end is in the `drive`.

pub(super) mod history;
pub(super) mod others;
pub(super) mod path;
pub(super) mod possible_state;
pub(super) mod question;
pub(super) mod set;
pub(super) mod words;
