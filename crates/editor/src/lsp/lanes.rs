//! The threads that answer requests: a quick answer never waits for a slow one (R12.7).

use std::io;

use crossbeam_channel::Sender;
use lsp_server::{RequestId, Response};
use serde_json::Value;

use super::requests::{Handler, Needs};
use super::view::RequestView;
use super::worker::Worker;

/// A question that waits for its answer.
pub(super) struct RoutedRequest {
    /// The number that the client gives it.
    pub(super) id: RequestId,
    /// Handler.
    pub(super) handler: Handler,
    /// Parameters.
    pub(super) params: Value,
    /// State of the server at the moment of the request.
    pub(super) view: RequestView,
}

/// A thread for each kind of answer.
pub(super) struct Lanes {
    answers: Worker<RoutedRequest>,
    reports: Worker<RoutedRequest>,
    simulations: Worker<RoutedRequest>,
}

impl Lanes {
    /// Starts the threads, which send their answers to the server.
    ///
    /// # Errors
    /// The system cannot start a thread.
    pub(super) fn new<D: From<Response> + Send + 'static>(done: &Sender<D>) -> io::Result<Self> {
        let lane = |name| {
            let done = done.clone();
            Worker::new(name, move |question: RoutedRequest| {
                if let Some(response) = question.answer() {
                    // The receiver is gone with the server.
                    let _ = done.send(response.into());
                }
            })
        };
        Ok(Self {
            answers: lane("answers")?,
            reports: lane("reports")?,
            simulations: lane("simulations")?,
        })
    }

    /// Sends a question to the thread of its kind.
    pub(super) fn send(&self, needs: Needs, question: RoutedRequest) {
        let lane = match needs {
            Needs::Texts | Needs::Check => &self.answers,
            Needs::Time => &self.reports,
            Needs::Simulation => &self.simulations,
        };
        lane.send(question);
    }
}

impl RoutedRequest {
    /// Returns the answer; `None` if the client has cancelled the request.
    fn answer(self) -> Option<Response> {
        if self.view.cancel.is_set() {
            return None;
        }
        Some(match (self.handler)(&self.view, self.params) {
            Ok(result) => Response::new_ok(self.id, result),
            Err(refusal) => refusal.of(self.id),
        })
    }
}
