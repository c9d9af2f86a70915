//! COMP commands and the messages about them (chapter 1), and what a reset or a restart makes of the states.

use crate::comp::{
    AxisIndex, CncBuild, CompCommand, CompensationError, Coupling, Kind, KindSet, Selection, State,
};
use crate::diagnostic::{Advice, Code, Diagnostic, nearest};
use crate::interpreter::axes::Addressed;
use crate::interpreter::block::BlockContext;
use crate::interpreter::control::OptionalSection;
use crate::interpreter::events::Outcome;
use crate::interpreter::executor::Executor;
use crate::interpreter::values::location::Unknown;
use crate::interpreter::ways::history::RepeatedSwitch;
use crate::interpreter::words::refusal::{PossibleRefusal, StopScope};
use crate::language::{ChainStep, ControlError, HashCommand};
use crate::lists::Origin;
use crate::machine::{Axis, AxisSet, Machine, Parameterisation};
use crate::readings::Question;
use crate::syntax::{Fault, is_axis_name};
use crate::text::Span;

impl Executor {
    pub(crate) fn comp(&mut self, command: &CompCommand, at: &BlockContext<'_>) {
        let before = self.scratch.changes.len();
        if self.state.control.optional != OptionalSection::Outside {
            let control = &self.state.control;
            let earlier = &mut self.scratch.earlier;
            earlier.get_or_insert_with(|| Box::new(control.earlier_states()));
        }
        self.warn_described(command, at);
        let axis = match self.state.control.addressed(&command.axis) {
            Ok(Addressed::Axis(axis)) => Ok(axis),
            Ok(Addressed::Absent(axis)) => return self.switch_released(command, axis, at),
            Ok(Addressed::Any) => return self.havoc_any_axis(command.selection.kinds()),
            Err(error) => Err(error),
        };
        let result = axis.and_then(|axis| {
            self.see(axis);
            self.refuse_other_channel(axis, command.span, at)?;
            if let Some(refused) = self.read_as_refused(command, axis, at) {
                return Err(refused);
            }
            let selection = self.not_yet_switched(command.selection, axis);
            self.warn_refusals(command, axis, at);
            let control = &mut self.state.control;
            let changes = &mut self.scratch.changes;
            control.compensation.switch(axis, selection, changes)?;
            control.history.close(axis, selection.kinds());
            Ok(axis)
        });
        match &result {
            Ok(axis) => {
                self.warn_opposite(command, *axis, at);
                self.warn_build(command, at);
                self.warn_ineffective(command, *axis, at);
                self.warn_optional(command, *axis, at);
            }
            Err(error) => {
                let diagnostic = refusal(&self.machine, error, command, at);
                self.scratch.messages.diagnostics.push(diagnostic);
            }
        }
        self.scratch.outcomes.push(Outcome {
            command: command.clone(),
            result,
            changes: self.scratch.changes.len() - before,
            repeated: RepeatedSwitch::default(),
        });
    }

    /// Reports FC328: a command in a region of which the manual lists the commands that it allows (R2.109).
    fn warn_described(&mut self, command: &CompCommand, at: &BlockContext<'_>) {
        let Some(described) = &self.state.control.described else {
            return;
        };
        let opener = described.opener;
        let what = format!("a COMP command stands within `{}`", opener.words);
        let refusal = PossibleRefusal::asked(opener.refuses_comp, Question::Described);
        self.may_refuse(refusal, &what, command.span, at);
    }

    /// Reports FC902: the PLC may skip the command (R2.109).
    fn warn_optional(&mut self, command: &CompCommand, axis: AxisIndex, at: &BlockContext<'_>) {
        match self.state.control.optional {
            OptionalSection::Outside => return,
            OptionalSection::Inside => self.havoc(axis, command.selection.kinds()),
            // The states are joined after the block.
            OptionalSection::Asked(_) => {}
        }
        let name = &command.axis;
        let message = format!(
            "this command is between `#OPTIONAL EXECUTION ON` and `OFF`, where the control skips blocks while it moves \
             backward or simulates; whether it switches axis `{name}` is not known"
        );
        let fault = Fault::new(Code::Fc902, command.span, message)
            .with_help("switch compensation outside of the section");
        let diagnostic = at.diagnostic(fault).with_axis(name.clone());
        self.scratch.messages.diagnostics.push(diagnostic);
    }

    /// Reports FC902 for a command to an axis that the program gave away, which the control may refuse (R2.70).
    fn switch_released(
        &mut self,
        command: &CompCommand,
        axis: Option<AxisIndex>,
        at: &BlockContext<'_>,
    ) {
        let kinds = command.selection.kinds();
        match axis {
            Some(axis) => self.havoc(axis, kinds),
            None => self.havoc_any_axis(kinds),
        }
        let name = &command.axis;
        let message = format!(
            "the program has given axis `{name}` away, so that the control may refuse this command; what it switches \
             is unknown"
        );
        let fault = Fault::new(Code::Fc902, command.span, message)
            .with_help("request the axis first, with `#CALL AX` or `#AX REQUEST`");
        let diagnostic = at.diagnostic(fault).with_axis(name.clone());
        self.scratch.messages.diagnostics.push(diagnostic);
    }

    /// Returns the refusal of a command that the control does not accept under the selected readings (R1.8, R1.25,
    /// R1.26).
    fn read_as_refused(
        &mut self,
        command: &CompCommand,
        axis: AxisIndex,
        at: &BlockContext<'_>,
    ) -> Option<CompensationError> {
        let compensation = &self.state.control.compensation;
        let kinds = command.selection.kinds();
        let state = compensation.state(axis, Kind::Frict);
        let is_on = matches!(command.selection, Selection::On(_));
        let is_lower = |fault: &Fault| {
            let within =
                command.span.start <= fault.span.start && fault.span.end <= command.span.end;
            fault.code == Code::Fc404 && within
        };
        let cases = [
            (
                Question::LowerCase,
                "keywords in lower case",
                at.block.faults.iter().any(is_lower),
            ),
            (
                Question::OffUnconfigured,
                "`COMP OFF` without P-AXIS-00522",
                !is_on && kinds.contains(Kind::Frict) && state == State::Unconfigured,
            ),
            (
                Question::OnWithoutList,
                "`COMP ON FRICT` without an accepted value list",
                is_on
                    && kinds.contains(Kind::Frict)
                    && compensation.is_configured(axis, Kind::Frict)
                    && !compensation.is_parameterised(axis, Kind::Frict),
            ),
        ];
        let mut asked = cases.into_iter().filter(|(_, _, applies)| *applies);
        let found = asked.find(|(question, ..)| {
            self.state.rests_on.insert(*question);
            self.machine.readings.takes_second(*question)
        });
        found.map(|(question, what, _)| CompensationError::ReadAsRefused {
            axis: command.axis.clone(),
            what,
            rule: question.facts().rule,
        })
    }

    /// Returns the kinds that a command switches where the first of a block wins (R1.31): those that no
    /// earlier command of the block named for the axis.
    fn not_yet_switched(&self, selection: Selection, axis: AxisIndex) -> Selection {
        if !self.machine.readings.takes_second(Question::OrderInBlock) {
            return selection;
        }
        let earlier = self.scratch.outcomes.iter();
        let earlier = earlier.filter(|it| it.result.as_ref().ok() == Some(&axis));
        let named = earlier.fold(KindSet::NONE, |named, it| {
            named.union(it.command.selection.kinds())
        });
        let left = selection.kinds().without(named);
        match selection {
            Selection::On(_) => Selection::On(left),
            Selection::Off(_) | Selection::OffAll => Selection::Off(left),
        }
    }

    /// Reports that the control may refuse a command that is right by itself: on that way the states stay as they are
    /// before it.
    fn warn_refusals(&mut self, command: &CompCommand, axis: AxisIndex, at: &BlockContext<'_>) {
        let compensation = &self.state.control.compensation;
        let is_coupled = compensation.coupling(axis) == Coupling::Perhaps;
        let is_rewritten = matches!(command.selection, Selection::On(_))
            && compensation.rewritten(axis).contains(Kind::Frict)
            && command.selection.kinds().contains(Kind::Frict);
        let is_transformed = !self.state.control.modal.transformed.is_empty();
        let may_be_refused = is_coupled || is_rewritten || is_transformed;
        if !may_be_refused || self.refusal_of(command, at).is_some() {
            return;
        }
        if is_coupled {
            self.warn_coupled(command, at);
        }
        if is_rewritten {
            self.warn_rewritten(command, at);
        }
        if is_transformed {
            self.warn_transformed(command, at);
        }
    }

    /// Reports FC902: the program wrote P-AXIS-00522, so that COMP may be refused (R2.92).
    fn warn_rewritten(&mut self, command: &CompCommand, at: &BlockContext<'_>) {
        let name = &command.axis;
        let message = format!(
            "`#MACHINE DATA` wrote a parameter of the friction compensation of axis `{name}`; whether the control accepts \
             this command is not known"
        );
        let fault = Fault::new(Code::Fc902, command.span, message)
            .with_help("run this part with a configuration that has the new value");
        self.say_before_parting(at.diagnostic(fault).with_axis(name.clone()));
        let scope = StopScope::Alike(format!("COMP ON of {name} after #MACHINE DATA").into());
        self.perhaps_stop((Unknown::Refused(Some(70495)), scope), command.span, at);
    }

    /// Reports FC902 for an axis that may be in a coupling, where COMP may be refused (TF5200 Diagnostics, ID 21403;
    /// R2.52).
    fn warn_coupled(&mut self, command: &CompCommand, at: &BlockContext<'_>) {
        let name = &command.axis;
        let message = format!(
            "whether axis `{name}` is in an active coupling is not known offline; if it is, the \
             control refuses this command, and what the command switches is unknown"
        );
        let fault = Fault::new(Code::Fc902, command.span, message)
            .with_help(Unknown::Refused(Some(21403)).advice());
        let diagnostic = at.diagnostic(fault).with_axis(name.clone());
        self.say_before_parting(diagnostic);
        self.perhaps_stop(
            (Unknown::Refused(Some(21403)), StopScope::Block),
            command.span,
            at,
        );
    }

    /// Reports FC411: the control may refuse COMP while a transformation is active; which ones is not documented
    /// (R1.42).
    fn warn_transformed(&mut self, command: &CompCommand, at: &BlockContext<'_>) {
        let active = self.state.control.modal.transformed.iter();
        let active: Vec<String> = active
            .filter(|name| is_transformation(name))
            .map(|name| format!("`{name}`"))
            .collect();
        if active.is_empty() {
            return;
        }
        let active = active.join(" or ");
        let message = format!(
            "the control may refuse COMP while {active} is active (error 50546); for which transformations \
             it does is not documented"
        );
        let fault = Fault::new(Code::Fc411, command.span, message).with_help(
            "switch compensation before the transformation is activated, or after its end",
        );
        self.say_before_parting(at.diagnostic(fault).with_axis(command.axis.clone()));
        // The control has one answer for each transformation.
        let scope = StopScope::Alike(format!("COMP while {active} is active").into());
        self.perhaps_stop((Unknown::Refused(Some(50546)), scope), command.span, at);
    }

    /// Reports FC301: the same axis and kind twice in one block with opposite states.
    fn warn_opposite(&mut self, command: &CompCommand, axis: AxisIndex, at: &BlockContext<'_>) {
        let on = |selection| matches!(selection, Selection::On(_));
        let opposite = self.scratch.outcomes.iter().find_map(|earlier| {
            let same_axis = earlier.result.as_ref().ok() == Some(&axis);
            let kinds = earlier
                .command
                .selection
                .kinds()
                .intersection(command.selection.kinds());
            (same_axis
                && !kinds.is_empty()
                && on(earlier.command.selection) != on(command.selection))
            .then_some((earlier.command.span, kinds))
        });
        if let Some((first, kinds)) = opposite {
            let keywords: Vec<&str> = kinds.iter().map(Kind::as_str).collect();
            let name = &command.axis;
            self.state.rests_on.insert(Question::OrderInBlock);
            let first_wins = self.machine.readings.takes_second(Question::OrderInBlock);
            let winner = if first_wins { "the first" } else { "this" };
            let fault = Fault::new(
                Code::Fc301,
                command.span,
                format!(
                    "`{}` of axis `{name}` is switched both on and off in this block; {winner} command wins",
                    keywords.join(" ")
                ),
            );
            let diagnostic = at
                .diagnostic(fault)
                .with_axis(name.clone())
                .with_label(at.place(first), "the opposite command is here");
            self.scratch.messages.diagnostics.push(diagnostic);
        }
    }

    /// Reports FC305: a kind that the configured build does not support (R1.10).
    fn warn_build(&mut self, command: &CompCommand, at: &BlockContext<'_>) {
        let Some(build) = self.machine.build else {
            return;
        };
        let named = match command.selection {
            Selection::On(kinds) | Selection::Off(kinds) => kinds,
            Selection::OffAll => KindSet::NONE,
        };
        for kind in named.iter() {
            let since: CncBuild = kind.facts().since;
            if build < since {
                let keyword = kind.as_str();
                let fault = Fault::new(
                    Code::Fc305,
                    command.span,
                    format!(
                        "`{keyword}` exists only since CNC build {since}; the machine has {build}"
                    ),
                );
                self.scratch
                    .messages
                    .diagnostics
                    .push(at.diagnostic(fault).with_axis(command.axis.clone()));
            }
        }
    }

    /// Reports FC303: selected, but nothing to work with (R1.26).
    fn warn_ineffective(&mut self, command: &CompCommand, axis: AxisIndex, at: &BlockContext<'_>) {
        let selects =
            matches!(command.selection, Selection::On(kinds) if kinds.contains(Kind::Frict));
        if !selects
            || self.state.control.compensation.state(axis, Kind::Frict) != State::Ineffective
        {
            return;
        }
        let name = &command.axis;
        let (missing, help) = match &self.machine.axis(axis).friction {
            Parameterisation::Missing => (
                "the axis has no value list".to_owned(),
                Advice::from(format!(
                    "give axis `{name}` a list with `frict_comp.mode 3` and table values"
                )),
            ),
            Parameterisation::Off => (
                "the value list says `frict_comp.mode 0`".to_owned(),
                "set P-COMP-00041 to 3".into(),
            ),
            Parameterisation::Rejected { file, code } => (
                format!("the value list `{file}` was rejected with {code}"),
                code.parse()
                    .ok()
                    .map_or_else(|| format!("{code} says why").into(), Advice::ReadPage),
            ),
            Parameterisation::Assumed | Parameterisation::Accepted(_) => return,
        };
        let fault = Fault::new(
            Code::Fc303,
            command.span,
            format!("friction compensation of axis `{name}` is selected without effect: {missing}"),
        )
        .with_help(help);
        self.scratch
            .messages
            .diagnostics
            .push(at.diagnostic(fault).with_axis(name.clone()));
    }

    /// Returns the message on a command that the control refuses in any state.
    pub(crate) fn refusal_of(
        &self,
        command: &CompCommand,
        at: &BlockContext<'_>,
    ) -> Option<Diagnostic> {
        let mut compensation = self.state.control.compensation.clone();
        let axis = compensation.resolve(&command.axis);
        let result =
            axis.and_then(|axis| compensation.switch(axis, command.selection, &mut Vec::new()));
        result
            .err()
            .map(|error| refusal(&self.machine, &error, command, at))
    }
}

fn refusal(
    machine: &Machine,
    error: &CompensationError,
    command: &CompCommand,
    at: &BlockContext<'_>,
) -> Diagnostic {
    let name = &command.axis;
    let axis_span = Span::new(
        command.span.start as usize,
        command.span.start as usize + name.len(),
    );
    let span = match error {
        CompensationError::UnknownAxis { .. } | CompensationError::NotInChannel { .. } => axis_span,
        _ => command.span,
    };
    let fault = Fault::new(error.code(), span, error.to_string());
    let mut diagnostic = at.diagnostic(fault).with_axis(name.clone());
    match error {
        CompensationError::NotConfigured { kind, .. } if *kind != Kind::Frict => {
            let facts = kind.facts();
            diagnostic = diagnostic.with_help(format!(
                "set {} (`{}`) in the axis list of `{name}` and restart the control",
                facts.parameter, facts.selector
            ));
        }
        CompensationError::NotConfigured { .. } => {
            let axis = machine.find(name).map(|axis| machine.axis(axis));
            let undescribed = axis.filter(|axis| !axis.is_described());
            diagnostic = diagnostic.with_help(match axis.map(|axis| &axis.frict_comp_origin) {
                Some(Origin::File { file, line }) => Advice::ConfigureInList {
                    axis: name.clone(),
                    file: file.clone(),
                    line: *line,
                },
                _ => undescribed.map_or_else(
                    || format!("P-AXIS-00522 (lr_param.frict_comp) of axis `{name}` is not set; set it to 1 in its axis list and restart the control").into(),
                    Axis::describing,
                ),
            });
            // Otherwise a list of all axes is shown above (R1.37).
            if machine.is_described() {
                diagnostic = diagnostic.with_help(Advice::Enable(vec![name.clone()]));
            }
            diagnostic
                .fixes
                .extend(axis.and_then(|axis| axis.configuring.clone()));
        }
        CompensationError::UnknownAxis { .. } => {
            diagnostic = advise_on_axis(machine, diagnostic, name);
        }
        CompensationError::NotInChannel { .. } => {
            let row = ControlError::of(20200);
            diagnostic.advice.extend(row.map(|row| row.cure.into()));
        }
        CompensationError::Coupled { .. } => {
            diagnostic =
                diagnostic.with_help("release the coupling first, with `#DISABLE AX LINK`");
        }
        CompensationError::ReadAsRefused { rule, .. } => {
            diagnostic = diagnostic.with_help(format!(
                "`\"{rule}\"` in `[reading]` selects this reading; the documents leave it open"
            ));
        }
        CompensationError::Spindle { .. } => {
            diagnostic =
                diagnostic.with_help("name an axis; a spindle in axis mode has its axis name");
        }
    }
    diagnostic
}

/// Adds advice on an axis that the machine does not have. Without a configuration the axes of the machine
/// are not known (R2.20).
fn advise_on_axis(machine: &Machine, mut diagnostic: Diagnostic, name: &str) -> Diagnostic {
    let known: Vec<&str> = machine.axes.iter().map(|axis| axis.name.as_str()).collect();
    let configured = machine.axis_set == AxisSet::Configured;
    let slaves = &machine.gantry_slaves;
    if let Some(slave) = slaves.iter().find(|slave| slave.name == name) {
        // R1.43
        return diagnostic.with_help(match &slave.master {
            Some(master) => format!(
                "`{name}` follows `{master}` as its static gantry slave; programs address only `{master}`"
            ),
            None => format!("`{name}` is the slave of a static gantry, which programs do not address"),
        });
    }
    let near = if configured {
        nearest(name, known.iter().copied())
    } else {
        let same = known.iter().find(|axis| axis.eq_ignore_ascii_case(name));
        same.copied().into_iter().collect()
    };
    diagnostic = diagnostic.with_near(name, &near);
    if configured {
        let all = known.join(", ");
        diagnostic = diagnostic.with_help(format!("the configuration lists all axes: {all}"));
        let one_more = machine.one_more_axis.as_ref();
        let added = one_more.filter(|_| is_axis_name(name));
        diagnostic.fixes.extend(added.map(|fix| fix.guess(name)));
    } else {
        diagnostic.message = format!(
            "no machine is described, and `{name}` is not one of the axes assumed without one"
        );
    }
    diagnostic.with_help(Advice::AddAxis(name.to_owned()))
}

/// Returns whether a name is one of a transformation between the coordinates of the program and those of the axes.
fn is_transformation(name: &str) -> bool {
    let row = HashCommand::named(name);
    row.is_some_and(|row| row.chain == Some(ChainStep::Coordinates))
}

impl Executor {
    /// Resets friction compensation, where the machine is read so (R1.28).
    pub(crate) fn reset_friction(&mut self) {
        if self.machine.readings.takes_second(Question::Reset) {
            for axis in (0..self.machine.axes.len()).map(AxisIndex::new) {
                self.return_to_start(axis);
            }
        }
    }

    /// Restarts the control (R1.29): every kind returns to its start-up state, unless the machine is read as keeping
    /// what was switched.
    pub(crate) fn restart(&mut self) {
        self.state.control.memory.restart();
        if !self.machine.readings.takes_second(Question::Restart) {
            self.state.control.history.close_all();
            self.state.control.compensation = self.machine.compensation();
            self.version += 1;
        }
    }
}
