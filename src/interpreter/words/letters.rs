//! Words of a block: axes, G, M, T and the other letters (R2.20 to R2.25, R2.45, R2.46).

use crate::comp::AxisIndex;
use crate::diagnostic::Code;
use crate::interpreter::axes::AxisNameMeaning;
use crate::interpreter::block::{BlockActions, BlockContext, Feed};
use crate::interpreter::control::ControlState;
use crate::interpreter::events::EndedBy;
use crate::interpreter::executor::Executor;
use crate::interpreter::motion::form::BlockEnd;
use crate::interpreter::motion::modal::Leaving;
use crate::interpreter::programs::calls::FunctionWord;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::values::value::{exact, rounded};
use crate::interpreter::words::refusal::{PossibleRefusal, StopScope};
use crate::language::{AxisWords, Described, GAction, GFunction, Group, HashAction};
use crate::readings::Question;
use crate::syntax::ast::{Address, Operand, Word};
use crate::syntax::{Fault, is_letter, is_program_number, not_known, repeated_word};
use crate::text::Span;

/// A word of one letter with its value, where that is known.
#[derive(Debug, Clone, Copy)]
struct LetterWord {
    letter: u8,
    value: Option<f64>,
    span: Span,
}

/// The least number of an M function that the control refuses in any case.
const FIRST_ABOVE_M: i64 = 1001;

impl Executor {
    pub(crate) fn word(&mut self, word: &Word, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let number = match &word.value {
            None => None,
            Some(Operand::Number(number)) => Some(*number),
            Some(operand) => self.number(*operand, word.span, at)?,
        };
        let are_own = self.state.control.channel_axes.are_own();
        if let Address::Letter(letter @ b'A'..=b'Z') = word.address {
            let name = char::from(letter);
            if !are_own
                && self.exchanged_word((name.encode_utf8(&mut [0; 4]), number), word.span, at)
            {
                return Ok(());
            }
            if let Some(axis) = self.names.letter(letter) {
                self.check_channel(axis, word.span, at)?;
                self.axis_word(axis, word.span, number);
                return Ok(());
            }
            let word = LetterWord {
                letter,
                value: number,
                span: word.span,
            };
            return self.letter(word, at);
        }
        self.named_word(word, number, at)
    }

    /// Executes a word whose address is not one of the letters that all axes and functions have.
    fn named_word(
        &mut self,
        word: &Word,
        number: Option<f64>,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        let name = match word.address {
            Address::Name(name) => {
                let name = name.of(at.text);
                let are_own = self.state.control.channel_axes.are_own();
                if !are_own && self.exchanged_word((name, number), word.span, at) {
                    return Ok(());
                }
                match self.names.get(name) {
                    Some(axis) => {
                        self.check_channel(axis, word.span, at)?;
                        self.axis_word(axis, word.span, number);
                    }
                    None if self.axes().is_main_spindle(name) => {
                        self.state.control.modal.pace.speed(number);
                    }
                    None if name.starts_with('S') => {}
                    None => self.lack_axis(name, word.span, at),
                }
                return Ok(());
            }
            Address::Main(letter) => match self.main_axis(letter) {
                Some(axis) => {
                    self.axis_word(axis, word.span, number);
                    return Ok(());
                }
                // The plane is not known, or it is `@I`, `@S`.
                None if letter >= b'X' => format!("@{}", char::from(letter)),
                None => return Ok(()),
            },
            Address::Lower(letter) => {
                self.lower_axis(letter, word.span, at);
                return Ok(());
            }
            Address::Letter(letter) => char::from(letter).to_string(),
        };
        self.pass_over(&name, word.span, at);
        Ok(())
    }

    /// Reports an axis name in lower case, `x10`: axis names are case-sensitive (R2.20), so its meaning is not known.
    fn lower_axis(&mut self, letter: u8, span: Span, at: &BlockContext<'_>) {
        let upper = letter.to_ascii_uppercase();
        let axis = self.axes().letter(upper);
        let mut fault = not_known(span.of(at.text), span);
        if let Some(axis) = axis {
            self.state.control.modal.havoc_position(axis);
            fault = fault.with_help(format!("did you mean `{}`?", char::from(upper)));
        }
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Takes a word of an axis that the program exchanged. Returns whether it is one.
    #[cold]
    fn exchanged_word(
        &mut self,
        (name, value): (&str, Option<f64>),
        span: Span,
        at: &BlockContext<'_>,
    ) -> bool {
        let is_axis = self.machine.find(name).is_some();
        match self.state.control.channel_axes.meaning(name) {
            Some(AxisNameMeaning::Axis(axis)) => self.axis_word(axis, span, value),
            Some(AxisNameMeaning::Released(_)) => self.say_released(name, span, at),
            Some(AxisNameMeaning::Unknown)
                if is_axis || self.state.control.channel_axes.has(name) =>
            {
                self.state.control.modal.havoc_positions();
                self.perhaps_move_all();
            }
            Some(AxisNameMeaning::Unknown) | None => return false,
        }
        true
    }

    /// Reports FC210: a word of an axis that the program gave away; once per axis and program (R2.70).
    fn say_released(&mut self, name: &str, span: Span, at: &BlockContext<'_>) {
        self.pass_over(name, span, at);
        if !self.state.is_new_word(name) {
            return;
        }
        let message = format!(
            "the program has given axis `{name}` away; its words are passed over, and what they move is not known"
        );
        let fault = Fault::new(Code::Fc210, at.in_block(span), message)
            .with_help("request the axis before its first word, with `#CALL AX` or `#AX REQUEST`");
        self.scratch.messages.diagnostics.push(at.diagnostic(fault));
    }

    /// Records a word of an axis that the machine does not have.
    fn lack_axis(&mut self, name: &str, span: Span, at: &BlockContext<'_>) {
        let exchanged = &self.state.control.channel_axes;
        let is_exchanged = exchanged.is_doubtful() || exchanged.has(name);
        if self.machine.axes_are_listed && !is_exchanged {
            let span = at.in_block(span);
            self.scratch.moves.lack(name.to_owned(), span);
        }
        self.pass_over(name, span, at);
    }

    /// Reports FC210: the block moves axes that the lists do not name (R2.94). Once per axis and program.
    #[cold]
    pub(crate) fn say_lacking(&mut self, words: AxisWords, at: &BlockContext<'_>) {
        for (name, span) in self.scratch.moves.take_lacking() {
            if !words.move_axes() || !self.state.is_new_word(&name) {
                continue;
            }
            let cause = match self.machine.find(&name) {
                Some(_) => format!("`{name}` is a spindle in the lists of the machine"),
                None => format!("the lists of the machine name no axis `{name}`"),
            };
            let message =
                format!("{cause}; its words are passed over, and what they move is not known");
            let axes = self.machine.axes.iter().filter(|axis| !axis.is_spindle());
            let known: Vec<&str> = axes.map(|axis| axis.name.as_str()).collect();
            let fault = Fault::new(Code::Fc210, span, message)
                .with_help(format!("the lists name {}", known.join(", ")));
            self.scratch.messages.diagnostics.push(at.diagnostic(fault));
        }
    }

    /// Reports FC210: an unknown word, which may do anything (R2.70).
    fn unread_word(&mut self, span: Span, at: &BlockContext<'_>) {
        let text = span.of(at.text);
        self.havoc_by_call(&Unknown::text(text));
        self.scratch
            .messages
            .diagnostics
            .push(at.diagnostic(not_known(text, span)));
    }

    /// Takes a word of the kind that most blocks consist of and that needs no message: a coordinate, a
    /// feed, a G function of a group, each with a plain number. Any other is left to [`Self::word`].
    #[inline]
    pub(crate) fn plain_word(&mut self, word: &Word) -> bool {
        let (&Address::Letter(letter @ b'A'..=b'Z'), &Some(Operand::Number(number))) =
            (&word.address, &word.value)
        else {
            return false;
        };
        if let Some(axis) = self.names.letter(letter) {
            let is_plain =
                self.state.control.channel_axes.are_own() && self.is_in_all_channels(axis);
            if is_plain {
                self.axis_word(axis, word.span, Some(number));
            }
            return is_plain;
        }
        match letter {
            b'F' if matches!(self.scratch.actions.feed, Feed::Absent) => {
                self.scratch.actions.feed = Feed::Given(Some(number));
            }
            b'G' => {
                let actions = &mut self.scratch.actions;
                return self.state.control.modal_word(number, actions);
            }
            _ => return false,
        }
        true
    }

    #[inline]
    pub(crate) fn axis_word(&mut self, axis: AxisIndex, span: Span, value: Option<f64>) {
        self.see(axis);
        self.scratch.moves.take_word(axis, span, value);
    }

    /// Reports FC313: an axis has one absolute coordinate in a block; incremental ones add up (R2.82).
    pub(crate) fn refuse_repeated_axes(&mut self, words: AxisWords, at: &BlockContext<'_>) {
        let modal = &self.state.control.modal;
        let absolute = modal.functions.absolute && modal.is_known(Group::Distance);
        if !absolute || words == AxisWords::Other {
            return;
        }
        for [first, second] in self.scratch.moves.drop_repeated() {
            let name = &self.machine.axis(second.axis).name;
            let fault = Fault::new(
                Code::Fc313,
                second.span,
                format!("axis `{name}` has a second coordinate in this block"),
            )
            .with_help("give an axis one coordinate per block; several add up only with G91");
            let said = at.diagnostic(fault).with_axis(name.clone());
            let said = said.with_label(at.place(first.span), "the first one is here");
            self.scratch.messages.diagnostics.push(said);
        }
    }

    fn letter(&mut self, word: LetterWord, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let LetterWord {
            letter,
            value: number,
            span,
        } = word;
        let whole = match letter {
            b'G' | b'M' | b'T' | b'D' => number.and_then(rounded),
            _ => None,
        };
        #[allow(clippy::float_cmp)] // whole numbers are exact
        let is_other =
            |whole: i64| i32::try_from(whole).is_ok_and(|whole| Some(f64::from(whole)) != number);
        if whole.is_some_and(|whole| whole < 0 || is_other(whole)) {
            // `G54.1` is a separate function, not G54; no function has a number below 0.
            self.unread_word(span, at);
            return Ok(());
        }
        // A T word may be a D word as well (P-CHAN-00014; TF5200 Diagnosis, error 20170).
        let gives_data = letter == b'T' && self.machine.programs.data_with_tool;
        if self.scratch.actions.is_repeated((letter, whole), at.block)
            || gives_data && self.scratch.actions.is_repeated((b'D', None), at.block)
        {
            return Err(Box::new(repeated_word(span.of(at.text), span)));
        }
        match (letter, whole) {
            (b'G', Some(number)) => return self.g_word(number, span, at),
            (b'G', None) => {
                self.scratch.actions.probes = true;
                self.unknown_word("G", span, at);
                self.state.control.modal.havoc_g(None);
            }
            (b'M', Some(30)) => self.scratch.actions.end = Some(EndedBy::M30),
            (b'M', Some(2)) => self.scratch.actions.end = Some(EndedBy::M02),
            (b'M', Some(17 | 29)) => self.scratch.actions.returns = true,
            (b'S', _) => self.state.control.modal.pace.speed(number),
            (b'E', _) => self.end_feed_word(number, span, at),
            (b'F', _) => self.scratch.actions.feed = Feed::Given(number),
            (b'M', None) => {
                self.unknown_word("M", span, at);
                self.scratch.read.plc_acts = true;
                self.part_at_unknown_m(span, at);
            }
            (b'M', Some(FIRST_ABOVE_M..)) => {
                let what = format!("`{}` is above M1000", span.of(at.text).trim());
                return Err(Fault::refused(Code::PErr20160, span, what));
            }
            (b'M' | b'T' | b'D', number) => {
                // A function may wait for its acknowledgement.
                self.scratch.moves.rest();
                self.scratch.read.plc_acts |=
                    letter == b'M' && self.may_acknowledge(letter, number);
                if letter == b'D' || gives_data {
                    self.state.control.modal.select_tool_data(number);
                }
                if let (b'M', Some(number)) = (letter, number) {
                    self.state.control.modal.pace.m(number);
                }
                self.function_word(FunctionWord { letter, number }, span, at);
            }
            (b'R', _) => {
                self.scratch.actions.radius = Some(at.in_block(span));
                self.circle_word(letter, number, span);
            }
            (b'I' | b'J' | b'K', _) => self.circle_word(letter, number, span),
            (b'P', _) if self.scratch.moves.dwells() => self.dwell_parameter(number),
            (b'H', _) => {
                let function = number.and_then(rounded);
                self.scratch.read.plc_acts |= self.may_acknowledge(letter, function);
            }
            (b'N', _) => {}
            (b'O', _) if is_program_number(at.block) => {
                self.pass_over("O", span, at);
                let refusal = PossibleRefusal::asked(20192, Question::ProgramNumber);
                self.may_refuse(refusal, "`O` gives a program number", span, at);
            }
            _ if !is_letter(letter) => self.unread_word(span, at),
            _ => self.lack_axis(&char::from(letter).to_string(), span, at),
        }
        Ok(())
    }

    /// Sets the feed at the end of the block; reports FC327 for one that is not above 0 (R2.113).
    fn end_feed_word(&mut self, feed: Option<f64>, span: Span, at: &BlockContext<'_>) {
        self.scratch.moves.geometry().end_feed = Some(feed);
        if let Some(feed) = feed.filter(|feed| *feed <= 0.0) {
            let message = format!("the feed `{feed}` at the end of this block is not above 0");
            let fault = Fault::new(Code::Fc327, at.in_block(span), message);
            let said = at.diagnostic(fault.with_help("write a feed above 0"));
            self.scratch.messages.diagnostics.push(said);
        }
    }

    fn g_word(&mut self, number: i64, span: Span, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        let Ok(number) = u32::try_from(number) else {
            self.pass_over(&format!("G{number}"), span, at);
            return Ok(());
        };
        let function = GFunction::of(number);
        self.scratch.actions.probes |= function.is_some_and(GFunction::is_measuring);
        if function.is_some_and(|function| self.scratch.actions.is_second_of_group(function)) {
            let message =
                format!("`G{number:02}` is the second G function of its group in this block");
            let fault = Fault::new(Code::Fc313, span, message)
                .with_help("a block takes one G function of each group");
            return Err(Box::new(fault));
        }
        let Some(function) = function else {
            self.further_g(number, span, at);
            return Ok(());
        };
        if function.is_refused_somewhere() {
            let states = (function.refused, function.flushes);
            self.check_states(states, &format!("G{number}"), span, at);
        }
        if let Some(group) = function.group {
            self.state.control.modal.set(group, number);
            return Ok(());
        }
        if let Some(step) = function.chain {
            self.state.control.modal.chain(step);
        }
        self.state.control.modal.switch_mode(function.mode);
        match function.action {
            GAction::Mirror | GAction::SwitchSpline => return Ok(()),
            GAction::Dwell => {
                self.scratch.actions.axis_words = function.axis_words;
                self.scratch.read.plc_acts = true;
                self.scratch.moves.dwell();
                return Ok(());
            }
            GAction::RestAtEnd => {
                self.scratch.moves.rest();
                self.scratch.moves.geometry().end = BlockEnd::ExactStop;
                return Ok(());
            }
            GAction::RunAtFullSpeed => {
                self.scratch.moves.geometry().at_full_speed = true;
                return Ok(());
            }
            GAction::SetReference => {
                self.scratch.actions.axis_words = function.axis_words;
                return Ok(());
            }
            GAction::SetRadius if self.radius_word(span, at) => {
                self.scratch.actions.radius = Some(at.in_block(span));
                return Ok(());
            }
            // PM/969743115
            GAction::Rotate if function.axis_words != AxisWords::Motion => {
                self.scratch.actions.axis_words = function.axis_words;
            }
            GAction::Rotate => {}
            GAction::WeighRapid => self.weigh_rapid(span, at),
            GAction::SetCuttingSpeed => self.state.control.modal.pace.cut(true),
            GAction::SetSpindleSpeed => self.state.control.modal.pace.cut(false),
            GAction::SwitchManual(switch) => {
                self.scratch.actions.manual = Some(switch);
                self.further_g(number, span, at);
                return Ok(());
            }
            GAction::PassOver | GAction::Call | GAction::SetRadius | GAction::WaitForOperator => {
                self.further_g(number, span, at);
                return Ok(());
            }
        }
        self.pass_over(&format!("G{number}"), span, at);
        Ok(())
    }

    /// Executes a G function without a bearing on the compensation, G61 and the like; a configured cycle has one.
    fn further_g(&mut self, number: u32, span: Span, at: &BlockContext<'_>) {
        if self.g_program(number, span, at) {
            return;
        }
        if let Some(function) = GFunction::of(number) {
            if let Some(motion) = function.motion {
                self.scratch.moves.move_as(motion);
            }
            if function.axis_words != AxisWords::Motion {
                self.scratch.actions.axis_words = function.axis_words;
            }
            if function.unmodelled.is_some() {
                self.scratch.moves.geometry().foreign = function.unmodelled;
            }
            if let Some((what, holds)) = function.simplifies {
                self.simplify(what, holds);
            }
        }
        self.pass_over(&format!("G{number}"), span, at);
    }

    /// Turns axis words into positions when the whole block is known: G90, G91, G70 and G92 apply
    /// wherever they are in the block, and F belongs to the feed mode of its block.
    pub(crate) fn move_axes(&mut self, at: &BlockContext<'_>) {
        if let Feed::Given(feed) = self.scratch.actions.feed {
            self.state.control.modal.set_feed(feed);
        }
        if let Some(described) = &self.state.control.described {
            if described.opener.action == HashAction::Describe(Described::Stroke) {
                let axes = self.scratch.moves.words().iter().map(|word| word.axis);
                self.state.control.modal.stroke.extend(axes);
            }
            self.scratch.moves.drop_all();
            return;
        }
        if matches!(self.scratch.actions.axis_words, AxisWords::Homing)
            && self.state.control.couplings.is_any()
            && let Some(word) = self.scratch.moves.words().first()
        {
            let what = "G74 is called while a coupling group is active";
            self.may_refuse(20137, what, word.span, at);
        }
        if self.state.control.modal.leaving != Leaving::Done {
            self.go_on_leaving();
        }
        // The lint for switches during motion looks at arcs (R1.57).
        let is_arc = self.state.control.modal.functions.is_arc();
        let is_followed = is_arc || self.options.takes_motions();
        let start = is_followed.then(|| self.state.control.modal.positions().to_vec());
        let modal = &mut self.state.control.modal;
        let moves = &mut self.scratch.moves;
        let before = self.scratch.actions.radius.map(|_| moves.ends(modal));
        match self.scratch.actions.axis_words {
            AxisWords::Motion => modal.move_axes(moves.coordinates()),
            AxisWords::Homing | AxisWords::Measuring => {
                for word in moves.words() {
                    modal.havoc_position(word.axis);
                }
            }
            AxisWords::Reference => modal.set_references(moves.words()),
            AxisWords::Other => {}
        }
        if let (Some(span), Some(before)) = (self.scratch.actions.radius, before) {
            self.warn_full_circle(span, &before, at);
        }
        if start.is_some() || self.scratch.moves.has_geometry() {
            self.take_motion(start, self.scratch.actions.axis_words);
        }
        if !self.scratch.actions.axis_words.move_axes() {
            self.scratch.moves.drop_words();
        }
    }

    /// The motion of the block takes the tool radius back after G40.
    #[cold]
    fn go_on_leaving(&mut self) {
        let plane = self.axes().plane(&self.state.control.modal);
        let words = self.scratch.moves.words();
        let moves = self.scratch.actions.axis_words.move_axes();
        let words = if moves { words } else { &[] };
        self.state.control.modal.go_on_leaving(&plane, words);
    }

    /// Reports FC316: R cannot describe a full circle; the end point must differ from the start (R2.46).
    fn warn_full_circle(&mut self, span: Span, before: &[Option<f64>], at: &BlockContext<'_>) {
        let circular = self.state.control.modal.functions.is_arc();
        let ends = self.scratch.moves.ends(&self.state.control.modal);
        let stays = !ends.is_empty() && ends.iter().all(Option::is_some) && ends == before;
        if circular && stays {
            let fault = Fault::new(
                Code::Fc316,
                span,
                "a circle by its radius ends where it starts; `R` cannot describe a full circle",
            )
            .with_help("give the centre of a full circle with `I`, `J`, `K`");
            self.say_before_parting(at.diagnostic(fault));
            // The control has one answer for all of them.
            let scope = StopScope::Alike("a full circle by its radius".into());
            let asked = (Unknown::Refused(Some(20034)), scope);
            self.perhaps_stop(asked, span, at);
        }
    }
}

impl ControlState {
    /// Puts a G function of a group into force, unless the block has another one of the group.
    #[inline]
    fn modal_word(&mut self, number: f64, actions: &mut BlockActions) -> bool {
        let Some(number) = exact(number) else {
            return false;
        };
        let Some(group) = Group::of(number) else {
            return false;
        };
        if self.modal.limits_words()
            && GFunction::of(number).is_some_and(GFunction::is_refused_somewhere)
        {
            return false;
        }
        if !actions.take_group(group) {
            return false;
        }
        self.modal.set(group, number);
        true
    }
}
