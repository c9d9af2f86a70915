//! The requests of a client, one after another.

use std::collections::BTreeSet;
use std::io::{self, BufRead, Write};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver};
use std::thread;

use serde_json::{Value, json};

use super::arguments::{
    Evaluate, Launch, SetBreakpoints, SetFilters, SetVariable, StepIn, Variables, arguments,
};
use super::breakpoints::{Breakpoints, STATE_CHANGES, UNKNOWN_VALUES};
use super::paths::real;
use super::stepper::{Halt, Moved, OutputText, RunPosition, RunTarget, Stepper, in_words};
use super::transport::{self, Incoming, Outgoing, Request};
use super::variables::{self, VariableScope};
use frictcomp::diagnostic::{Diagnostic, Severity};
use frictcomp::interpreter::EndedBy;
use frictcomp::machine::Setting;
use frictcomp_host::read_text;

/// The only thread: the channel that runs the program.
const CHANNEL: i64 = 1;

/// Serves one client until it disconnects or closes its end of the input.
///
/// # Errors
/// The client cannot be read from or written to.
pub fn serve(input: impl BufRead + Send + 'static, output: impl Write) -> io::Result<()> {
    let (sender, receiver) = mpsc::channel();
    thread::Builder::new()
        .name("reader".to_owned())
        .spawn(move || {
            let mut input = input;
            while let Ok(Some(incoming)) = transport::read(&mut input) {
                if sender.send(incoming).is_err() {
                    return;
                }
            }
        })?;
    let mut server = DapServer {
        client: DapClient {
            receiver,
            waiting: Vec::new(),
        },
        outgoing: Outgoing::new(output),
        breakpoints: Breakpoints::default(),
        stepper: None,
        stop_on_entry: true,
        moved: Moved::No,
        is_over: false,
    };
    while let Some(incoming) = server.client.next() {
        let request = match incoming {
            Incoming::Request(request) => request,
            Incoming::Garbled(why) => {
                server.print(
                    "stderr",
                    &format!("a message that is not a request was ignored: {why}"),
                )?;
                continue;
            }
        };
        let is_last = request.command == "disconnect";
        server.serve(&request)?;
        if is_last {
            break;
        }
    }
    Ok(())
}

/// The client's end: the messages it sent, in order.
struct DapClient {
    receiver: Receiver<Incoming>,
    /// Messages taken from the receiver ahead of their turn.
    waiting: Vec<Incoming>,
}

impl DapClient {
    fn next(&mut self) -> Option<Incoming> {
        if self.waiting.is_empty() {
            return self.receiver.recv().ok();
        }
        Some(self.waiting.remove(0))
    }

    /// Returns whether it has sent a request that cannot wait until the run stops by itself.
    fn interrupts(&mut self) -> bool {
        self.waiting.extend(self.receiver.try_iter());
        self.waiting
            .iter()
            .any(|incoming| is_one_of(incoming, &STOPS) || is_one_of(incoming, &AT_ONCE))
    }

    /// Takes the next request that can be answered during a run.
    fn take_at_once(&mut self) -> Option<Request> {
        let at = self.waiting.iter().position(|it| is_one_of(it, &AT_ONCE))?;
        match self.waiting.remove(at) {
            Incoming::Request(request) => Some(request),
            Incoming::Garbled(_) => None,
        }
    }

    /// Returns the first request that stops a run.
    fn stop(&self) -> Option<&Request> {
        self.waiting.iter().find_map(|incoming| match incoming {
            Incoming::Request(request) if is_one_of(incoming, &STOPS) => Some(request),
            _ => None,
        })
    }
}

/// Requests that stop a run.
const STOPS: [&str; 3] = ["pause", "disconnect", "terminate"];

/// Requests that are answered during a run.
const AT_ONCE: [&str; 3] = ["setBreakpoints", "setExceptionBreakpoints", "threads"];

fn is_one_of(incoming: &Incoming, commands: &[&str]) -> bool {
    match incoming {
        Incoming::Request(request) => commands.contains(&request.command.as_str()),
        Incoming::Garbled(_) => false,
    }
}

struct DapServer<W> {
    client: DapClient,
    outgoing: Outgoing<W>,
    breakpoints: Breakpoints,
    stepper: Option<Stepper>,
    stop_on_entry: bool,
    /// Motion of the run to another block by the request itself.
    moved: Moved,
    /// Whether the client was informed that the run has ended.
    is_over: bool,
}

impl<W: Write> DapServer<W> {
    /// Answers a request, and does what comes after the answer.
    fn serve(&mut self, request: &Request) -> io::Result<()> {
        self.moved = Moved::No;
        let answer = self.answer(request);
        let is_done = answer.is_ok();
        self.outgoing.respond(request, answer)?;
        if !is_done {
            return Ok(());
        }
        match request.command.as_str() {
            // A skipped block is passed over.
            "stepIn" | "setVariable" if self.moved == Moved::Yes => self.stopped("step", ""),
            "launch" => self.outgoing.event("initialized", &json!({})),
            "configurationDone" => self.begin(),
            "continue" => self.go(RunTarget::Breakpoint),
            "stepIn" => self.go(RunTarget::Block),
            "next" => self.go(RunTarget::Depth(self.depth())),
            "stepOut" => {
                let above = self.depth().checked_sub(1);
                self.go(above.map_or(RunTarget::Breakpoint, RunTarget::Depth))
            }
            "terminate" => {
                self.stepper = None;
                self.terminated()
            }
            _ => Ok(()),
        }
    }

    fn answer(&mut self, request: &Request) -> Result<Value, String> {
        match request.command.as_str() {
            "initialize" => Ok(capabilities()),
            "launch" => self.launch(arguments(request)?),
            "setBreakpoints" => self.set_breakpoints(arguments(request)?),
            "setExceptionBreakpoints" => self.set_filters(&arguments(request)?),
            "threads" => Ok(json!({ "threads": [{ "id": CHANNEL, "name": "NC channel" }] })),
            "stackTrace" => self.stepper().map(stack),
            "scopes" => self
                .stepper()
                .map(|stepper| json!({ "scopes": VariableScope::all(stepper) })),
            "variables" => {
                let Variables {
                    variables_reference,
                } = arguments(request)?;
                let stepper = self.stepper()?;
                Ok(json!({ "variables": variables::variables(stepper, variables_reference) }))
            }
            "setVariable" => self.set_variable(&arguments(request)?),
            "evaluate" => {
                let Evaluate { expression } = arguments(request)?;
                variables::evaluate(self.stepper()?, &expression)
            }
            "continue" => self
                .stepper()
                .map(|_| json!({ "allThreadsContinued": true })),
            "stepInTargets" => self
                .stepper()
                .map(|stepper| json!({ "targets": sides(stepper) })),
            "stepIn" => {
                self.stepper()?;
                if !request.arguments.is_null() {
                    let StepIn { target_id } = arguments(request)?;
                    target_id.map_or(Ok(()), |place| self.choose(place))?;
                }
                Ok(json!({}))
            }
            "configurationDone" | "next" | "stepOut" => self.stepper().map(|_| json!({})),
            "pause" | "disconnect" | "terminate" => Ok(json!({})),
            other => Err(format!("`{other}` is not supported")),
        }
    }

    fn stepper(&self) -> Result<&Stepper, String> {
        let missing = || "no program was launched".to_owned();
        self.stepper.as_ref().ok_or_else(missing)
    }

    fn launch(&mut self, launch: Launch) -> Result<Value, String> {
        let settings: Vec<(String, Setting)> = launch
            .set
            .into_iter()
            .map(|(name, value)| match value {
                Value::Number(number) => {
                    Ok((name, Setting::Number(number.as_f64().unwrap_or(f64::NAN))))
                }
                Value::String(text) => Ok((name, Setting::Text(text))),
                other => Err(format!(
                    "`{name}` must be a number or a text, found `{other}`"
                )),
            })
            .collect::<Result<_, _>>()?;
        let stepper = Stepper::new(&launch.program, &settings);
        self.stepper = Some(stepper.map_err(|error| {
            let reasons = error.diagnostics().iter().map(in_words);
            let words: Vec<String> = [error.to_string()].into_iter().chain(reasons).collect();
            words.join("; ")
        })?);
        self.stop_on_entry = launch.stop_on_entry;
        Ok(json!({}))
    }

    fn set_breakpoints(&mut self, wanted: SetBreakpoints) -> Result<Value, String> {
        let file = real(&wanted.source.path);
        let text = read_text(&file).map_err(|error| error.to_string())?;
        let lines: Vec<u32> = wanted.breakpoints.iter().map(|it| it.line).collect();
        let found = self.breakpoints.set_lines(file, &text, wanted.breakpoints);
        let told = found
            .into_iter()
            .zip(lines)
            .map(|(found, line)| match found {
                Ok(line) => json!({ "verified": true, "line": line }),
                Err(why) => json!({ "verified": false, "line": line, "message": why }),
            });
        Ok(json!({ "breakpoints": told.collect::<Vec<_>>() }))
    }

    /// Takes the filters, and returns for each whether it can be used.
    fn set_filters(&mut self, wanted: &SetFilters) -> Result<Value, String> {
        let stepper = self.stepper()?;
        let (mut changes, mut unknown) = (None, false);
        let mut told = Vec::new();
        let plain = wanted.filters.iter().map(|id| (id.as_str(), ""));
        let options = wanted.filter_options.iter();
        let options = options.map(|it| (it.filter_id.as_str(), it.condition.as_str()));
        for (id, condition) in plain.chain(options) {
            let taken = match id {
                STATE_CHANGES => watched(stepper, condition).map(|axes| changes = Some(axes)),
                UNKNOWN_VALUES if condition.trim().is_empty() => {
                    unknown = true;
                    Ok(())
                }
                UNKNOWN_VALUES => Err("this filter takes no condition".to_owned()),
                _ => Err(format!("there is no filter `{id}`")),
            };
            told.push(match taken {
                Ok(()) => json!({ "verified": true }),
                Err(why) => json!({ "verified": false, "message": why }),
            });
        }
        self.breakpoints.set_filters(changes, unknown);
        Ok(json!({ "breakpoints": told }))
    }

    /// Takes a side of the condition of the block that is shown.
    fn choose(&mut self, place: usize) -> Result<(), String> {
        let stepper = self.stepper.as_mut().ok_or("no program was launched")?;
        self.moved = stepper.choose(place)?;
        Ok(())
    }

    /// Takes the side that a variable names.
    fn set_side(&mut self, wanted: &SetVariable) -> Result<Value, String> {
        let place = self.stepper()?.answers().position(|it| it == wanted.name);
        match (place, wanted.value.trim()) {
            (Some(place), "1" | "true") => self.choose(place)?,
            _ => return Err("set 1 to take this side".to_owned()),
        }
        Ok(json!({ "value": "taken" }))
    }

    fn set_variable(&mut self, wanted: &SetVariable) -> Result<Value, String> {
        if wanted.variables_reference == VariableScope::Sides as i64 {
            return self.set_side(wanted);
        }
        let stepper = self.stepper.as_mut().ok_or("no program was launched")?;
        if wanted.variables_reference != VariableScope::Unknown as i64 {
            return Err(
                "only a value that the machine alone knows can be set; what the program \
                        computes stays as it is"
                    .to_owned(),
            );
        }
        let setting = variables::setting(&wanted.value)
            .ok_or_else(|| format!("`{}` is not a number or a text in quotes", wanted.value))?;
        stepper.set(&wanted.name, &setting);
        Ok(json!({ "value": wanted.value.trim() }))
    }

    /// Begins the run after the client has set its breakpoints.
    fn begin(&mut self) -> io::Result<()> {
        self.tell_said()?;
        if !self.stop_on_entry {
            return self.go(RunTarget::Breakpoint);
        }
        let Some(stepper) = &mut self.stepper else {
            return Ok(());
        };
        let halt = stepper.go(RunTarget::Block, &mut self.breakpoints, &mut || false);
        self.tell_said()?;
        match halt {
            Halt::Ended(by) => self.end(by),
            halt => {
                let (_, what) = self.reason(&halt);
                let first = "before the first block".to_owned();
                self.stopped("entry", &what.filter(|it| !it.is_empty()).unwrap_or(first))
            }
        }
    }

    fn depth(&self) -> usize {
        self.stepper.as_ref().map_or(0, Stepper::depth)
    }

    /// Continues the run, and meanwhile answers the requests that do not stop it.
    fn go(&mut self, reach: RunTarget) -> io::Result<()> {
        loop {
            let Some(stepper) = &mut self.stepper else {
                return Ok(());
            };
            let client = &mut self.client;
            let halt = stepper.go(reach, &mut self.breakpoints, &mut || client.interrupts());
            self.tell_said()?;
            if let Halt::Ended(by) = halt {
                return self.end(by);
            }
            if halt != Halt::Interrupted {
                let (reason, what) = self.reason(&halt);
                return self.stopped(reason, &what.unwrap_or_default());
            }
            while let Some(request) = self.client.take_at_once() {
                let answer = self.answer(&request);
                self.outgoing.respond(&request, answer)?;
            }
            match self.client.stop().map(|request| request.command.as_str()) {
                None => {}
                Some("pause") => return self.stopped("pause", ""),
                // The run is not seen again.
                Some(_) => return Ok(()),
            }
        }
    }

    fn stopped(&mut self, reason: &str, text: &str) -> io::Result<()> {
        if let Some(RunPosition::Ended(by)) = self.stepper.as_ref().map(Stepper::position) {
            return self.end(*by);
        }
        if let Some(stepper) = &mut self.stepper {
            stepper.show();
        }
        let mut body = json!({ "reason": reason, "threadId": CHANNEL, "allThreadsStopped": true });
        if !text.is_empty() {
            body["description"] = text.into();
            body["text"] = text.into();
        }
        self.outgoing.event("stopped", &body)
    }

    /// Reports the states that the program leaves, and that it has ended.
    fn end(&mut self, by: EndedBy) -> io::Result<()> {
        let left = self
            .stepper
            .as_ref()
            .map(variables::states)
            .unwrap_or_default();
        self.print(
            "console",
            &format!("the program ends by {by} and leaves {left}"),
        )?;
        self.terminated()?;
        self.outgoing.event(
            "exited",
            &json!({ "exitCode": i32::from(matches!(by, EndedBy::Error | EndedBy::Budget)) }),
        )
    }

    /// Tells the client, once, that the run is over.
    fn terminated(&mut self) -> io::Result<()> {
        if std::mem::replace(&mut self.is_over, true) {
            return Ok(());
        }
        self.outgoing.event("terminated", &json!({}))
    }

    fn tell_said(&mut self) -> io::Result<()> {
        let said = self.stepper.as_mut().map(Stepper::take_said);
        said.into_iter().flatten().try_for_each(|it| match it {
            OutputText::Message(message) => self.tell(&message),
            OutputText::Log { file, line, text } => {
                let body = json!({
                    "category": "console",
                    "output": format!("{text}\n"),
                    "source": source(&file),
                    "line": line,
                });
                self.outgoing.event("output", &body)
            }
        })
    }

    fn tell(&mut self, said: &Diagnostic) -> io::Result<()> {
        let category = match said.severity {
            Severity::Error => "stderr",
            _ => "console",
        };
        let line = said.place.start().line;
        let body = json!({
            "category": category,
            "output": format!("{}\n", in_words(said)),
            "source": source(&said.place.file),
            "line": line,
        });
        self.outgoing.event("output", &body)
    }

    /// Returns the reason for a stop in the words of the protocol, and its description.
    fn reason(&self, halt: &Halt) -> (&'static str, Option<String>) {
        match halt {
            Halt::Arrived | Halt::Ended(_) => ("step", None),
            Halt::Interrupted => ("pause", None),
            Halt::Breakpoint(what) => ("breakpoint", Some(what.clone())),
            Halt::Changed(what) => ("data breakpoint", Some(what.clone())),
            Halt::Error(what) => ("exception", Some(what.clone())),
            Halt::Unknown(names) => {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let names = names.join(", ");
                let sides = self.stepper.iter().flat_map(Stepper::answers);
                let sides: Vec<String> = sides.map(|side| format!("`{side}`")).collect();
                let choice = match sides.as_slice() {
                    [] => String::new(),
                    sides => format!(", or take a side: {}", sides.join(", ")),
                };
                let what = format!(
                    "the block reads {names}, which only the machine knows: set a value in the scope of that name{choice}"
                );
                ("exception", Some(what))
            }
        }
    }

    fn print(&mut self, category: &str, text: &str) -> io::Result<()> {
        let body = json!({ "category": category, "output": format!("{text}\n") });
        self.outgoing.event("output", &body)
    }
}

/// Returns the axes that a condition names.
///
/// # Errors
/// One of them is not an axis; the reason in words.
fn watched(stepper: &Stepper, condition: &str) -> Result<BTreeSet<String>, String> {
    let names = condition.split([' ', ',', ';']).filter(|it| !it.is_empty());
    let axes: BTreeSet<String> = names.map(str::to_ascii_uppercase).collect();
    match axes.iter().find(|axis| !stepper.has_axis(axis)) {
        Some(other) => Err(format!(
            "neither the machine nor the program has an axis `{other}`"
        )),
        None => Ok(axes),
    }
}

fn capabilities() -> Value {
    json!({
        "supportsConditionalBreakpoints": true,
        "supportsHitConditionalBreakpoints": true,
        "supportsLogPoints": true,
        "supportsConfigurationDoneRequest": true,
        "supportsSetVariable": true,
        "supportsStepInTargetsRequest": true,
        "supportsEvaluateForHovers": true,
        "supportsTerminateRequest": true,
        "supportsExceptionFilterOptions": true,
        "exceptionBreakpointFilters": [
            {
                "filter": STATE_CHANGES,
                "label": "A state changes",
                "description": "Stops after a block that changes the friction compensation of an axis.",
                "default": true,
                "supportsCondition": true,
                "conditionDescription": "the axes, such as X Y; all of them without a condition",
            },
            {
                "filter": UNKNOWN_VALUES,
                "label": "A value only the machine knows",
                "description": "Stops before a block that reads such a value, so that it can be set.",
                "default": true,
            },
        ],
    })
}

/// Returns the sides of the condition of the next block.
fn sides(stepper: &Stepper) -> Vec<Value> {
    let sides = stepper.answers().enumerate();
    let sides = sides.map(|(id, words)| json!({ "id": id, "label": words }));
    sides.collect()
}

/// Returns the calls that led to the next block, the innermost first.
fn stack(stepper: &Stepper) -> Value {
    let sites = match stepper.position() {
        RunPosition::Before(sites) => sites.as_slice(),
        RunPosition::Ended(_) => &[],
    };
    let frames: Vec<Value> = (1..)
        .zip(sites.iter().rev())
        .map(|(id, site)| {
            json!({
                "id": id,
                "name": site.text.lines().next().unwrap_or_default().trim(),
                "source": source(&site.file),
                "line": site.line,
                "column": 1,
            })
        })
        .collect();
    json!({ "totalFrames": frames.len(), "stackFrames": frames })
}

fn source(file: &str) -> Value {
    let path = std::path::absolute(file).unwrap_or_else(|_| PathBuf::from(file));
    let name = path.file_name().map(|name| name.to_string_lossy());
    json!({ "name": name, "path": path.to_string_lossy() })
}
