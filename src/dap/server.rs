//! The requests of a client, one after another.

use std::collections::BTreeSet;
use std::io::{self, BufRead, Write};
use std::path::PathBuf;
use std::sync::mpsc::{self, Receiver};
use std::thread;

use serde_json::{Value, json};

use super::arguments::{
    Evaluate, Launch, SetBreakpoints, SetFilters, SetVariable, Variables, arguments,
};
use super::breakpoints::{Breakpoints, STATE_CHANGES, UNKNOWN_VALUES};
use super::paths::real;
use super::stepper::{Halt, Position, Reach, Stepper, in_words};
use super::transport::{self, Incoming, Outgoing, Request};
use super::variables::{self, Scope};
use crate::diagnostic::{Diagnostic, Severity};
use crate::host::read_text;
use crate::interpreter::EndedBy;
use crate::machine::Setting;

/// The only thread: the channel that runs the program.
const CHANNEL: i64 = 1;

/// Serves one client until it disconnects or its end of the input is closed.
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
    let mut server = Server {
        client: Client {
            receiver,
            waiting: Vec::new(),
        },
        outgoing: Outgoing::new(output),
        breakpoints: Breakpoints::default(),
        stepper: None,
        stop_on_entry: true,
    };
    while let Some(incoming) = server.client.next() {
        let request = match incoming {
            Incoming::Request(request) => request,
            Incoming::Garbled(why) => {
                server.print(
                    "stderr",
                    &format!("a message that is no request was passed over: {why}"),
                )?;
                continue;
            }
        };
        let is_last = matches!(request.command.as_str(), "disconnect" | "terminate");
        server.serve(&request)?;
        if is_last {
            break;
        }
    }
    Ok(())
}

/// The client's end: what it sent, in order.
struct Client {
    receiver: Receiver<Incoming>,
    /// What was taken from the receiver ahead of its turn.
    waiting: Vec<Incoming>,
}

impl Client {
    fn next(&mut self) -> Option<Incoming> {
        if self.waiting.is_empty() {
            return self.receiver.recv().ok();
        }
        Some(self.waiting.remove(0))
    }

    /// Whether it wants a run to stop. Everything else waits until the run stops by itself.
    fn wants_a_stop(&mut self) -> bool {
        self.waiting.extend(self.receiver.try_iter());
        let stops = ["pause", "disconnect", "terminate"];
        self.waiting.iter().any(|incoming| match incoming {
            Incoming::Request(request) => stops.contains(&request.command.as_str()),
            Incoming::Garbled(_) => false,
        })
    }
}

struct Server<W> {
    client: Client,
    outgoing: Outgoing<W>,
    breakpoints: Breakpoints,
    stepper: Option<Stepper>,
    stop_on_entry: bool,
}

impl<W: Write> Server<W> {
    /// Answers a request, and does what comes after the answer.
    fn serve(&mut self, request: &Request) -> io::Result<()> {
        let answer = self.answer(request);
        let is_done = answer.is_ok();
        self.outgoing.respond(request, answer)?;
        if !is_done {
            return Ok(());
        }
        match request.command.as_str() {
            "launch" => self.outgoing.event("initialized", &json!({})),
            "configurationDone" => self.begin(),
            "continue" => self.go(|_| Reach::Breakpoint),
            "stepIn" => self.go(|_| Reach::Block),
            "next" => self.go(Reach::Depth),
            "stepOut" => {
                self.go(|depth| depth.checked_sub(1).map_or(Reach::Breakpoint, Reach::Depth))
            }
            _ => Ok(()),
        }
    }

    fn answer(&mut self, request: &Request) -> Result<Value, String> {
        match request.command.as_str() {
            "initialize" => Ok(capabilities()),
            "launch" => self.launch(arguments(request)?),
            "setBreakpoints" => self.set_breakpoints(&arguments(request)?),
            "setExceptionBreakpoints" => Ok(self.set_filters(&arguments(request)?)),
            "threads" => Ok(json!({ "threads": [{ "id": CHANNEL, "name": "NC channel" }] })),
            "stackTrace" => self.stepper().map(stack),
            "scopes" => self
                .stepper()
                .map(|stepper| json!({ "scopes": Scope::all(stepper) })),
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
                variables::by_name(self.stepper()?, &expression)
                    .ok_or_else(|| format!("`{expression}` has no value here"))
            }
            "continue" => self
                .stepper()
                .map(|_| json!({ "allThreadsContinued": true })),
            "configurationDone" | "next" | "stepIn" | "stepOut" => {
                self.stepper().map(|_| json!({}))
            }
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

    fn set_breakpoints(&mut self, wanted: &SetBreakpoints) -> Result<Value, String> {
        let file = real(&wanted.source.path);
        let text = read_text(&file).map_err(|error| error.to_string())?;
        let lines: Vec<u32> = wanted.breakpoints.iter().map(|it| it.line).collect();
        let found = self.breakpoints.set_lines(file, &text, &lines);
        let told = found.into_iter().zip(lines).map(|(found, line)| match found {
            Some(line) => json!({ "verified": true, "line": line }),
            None => json!({ "verified": false, "line": line, "message": "no block stands here or below" }),
        });
        Ok(json!({ "breakpoints": told.collect::<Vec<_>>() }))
    }

    fn set_filters(&mut self, wanted: &SetFilters) -> Value {
        let with_condition = |id: &str| wanted.filter_options.iter().find(|it| it.filter_id == id);
        let is_on =
            |id: &str| wanted.filters.iter().any(|it| it == id) || with_condition(id).is_some();
        let axes = with_condition(STATE_CHANGES).map_or("", |option| &option.condition);
        let axes: BTreeSet<String> = axes
            .split([' ', ',', ';'])
            .filter(|axis| !axis.is_empty())
            .map(str::to_ascii_uppercase)
            .collect();
        let changes = is_on(STATE_CHANGES).then_some(axes);
        self.breakpoints.set_filters(changes, is_on(UNKNOWN_VALUES));
        json!({})
    }

    fn set_variable(&mut self, wanted: &SetVariable) -> Result<Value, String> {
        let stepper = self.stepper.as_mut().ok_or("no program was launched")?;
        if wanted.variables_reference != Scope::Unknown as i64 {
            return Err(
                "only a value that the machine alone knows can be set; what the program \
                        computes stays as it is"
                    .to_owned(),
            );
        }
        let setting = variables::setting(&wanted.value)
            .ok_or_else(|| format!("`{}` is no number and no text in quotes", wanted.value))?;
        stepper.set(&wanted.name, &setting);
        Ok(json!({ "value": wanted.value.trim() }))
    }

    /// The client has set its breakpoints: the run begins.
    fn begin(&mut self) -> io::Result<()> {
        self.tell_said()?;
        let position = self.stepper.as_ref().map(Stepper::position);
        match position {
            Some(&Position::Ended(by)) => self.end(by),
            Some(Position::Before(_)) if self.stop_on_entry => {
                self.stopped("entry", "before the first block")
            }
            _ => self.go(|_| Reach::Breakpoint),
        }
    }

    /// Lets the run go on as far as the depth of the block says that is shown.
    fn go(&mut self, reach: impl FnOnce(usize) -> Reach) -> io::Result<()> {
        let Some(stepper) = &mut self.stepper else {
            return Ok(());
        };
        let client = &mut self.client;
        let halt = stepper.go(reach(stepper.depth()), &mut self.breakpoints, &mut || {
            client.wants_a_stop()
        });
        self.tell_said()?;
        match halt {
            Halt::Arrived => self.stopped("step", ""),
            Halt::Breakpoint => self.stopped("breakpoint", ""),
            Halt::Interrupted => self.stopped("pause", ""),
            Halt::Changed(what) => self.stopped("data breakpoint", &what),
            Halt::Error(what) => self.stopped("exception", &what),
            Halt::Unknown(names) => {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let what = format!(
                    "the block reads {}, which only the machine knows",
                    names.join(", ")
                );
                self.stopped("exception", &what)
            }
            Halt::Ended(by) => self.end(by),
        }
    }

    fn stopped(&mut self, reason: &str, text: &str) -> io::Result<()> {
        if let Some(Position::Ended(by)) = self.stepper.as_ref().map(Stepper::position) {
            return self.end(*by);
        }
        let mut body = json!({ "reason": reason, "threadId": CHANNEL, "allThreadsStopped": true });
        if !text.is_empty() {
            body["description"] = text.into();
            body["text"] = text.into();
        }
        self.outgoing.event("stopped", &body)
    }

    /// Says what the program leaves, and that it has ended.
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
        self.outgoing.event("terminated", &json!({}))?;
        self.outgoing.event(
            "exited",
            &json!({ "exitCode": i32::from(matches!(by, EndedBy::Error | EndedBy::Budget)) }),
        )
    }

    fn tell_said(&mut self) -> io::Result<()> {
        let said = self.stepper.as_mut().map(Stepper::take_said);
        said.into_iter().flatten().try_for_each(|it| self.tell(&it))
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

    fn print(&mut self, category: &str, text: &str) -> io::Result<()> {
        let body = json!({ "category": category, "output": format!("{text}\n") });
        self.outgoing.event("output", &body)
    }
}

fn capabilities() -> Value {
    json!({
        "supportsConfigurationDoneRequest": true,
        "supportsSetVariable": true,
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
                "conditionDescription": "the axes, X Y for instance; all of them without a condition",
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

/// The calls that led to the next block, the innermost first.
fn stack(stepper: &Stepper) -> Value {
    let sites = match stepper.position() {
        Position::Before(sites) => sites.as_slice(),
        Position::Ended(_) => &[],
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
