//! Refusals of a question.

use lsp_server::{ErrorCode, RequestId, Response};

use frictcomp_host::HostError;

/// Reason why a question has no answer.
#[derive(Debug)]
pub(super) enum Refusal {
    /// Parameters that cannot be understood.
    Params(String),
    /// The answer cannot be found.
    Failed(String),
}

impl Refusal {
    /// Returns the refusal of a question.
    pub(super) fn of(self, id: RequestId) -> Response {
        let (code, message) = match self {
            Self::Params(message) => (ErrorCode::InvalidParams, message),
            Self::Failed(message) => (ErrorCode::RequestFailed, message),
        };
        Response::new_err(id, code as i32, message)
    }
}

impl From<serde_json::Error> for Refusal {
    fn from(error: serde_json::Error) -> Self {
        Self::Params(format!("the parameters cannot be read: {error}"))
    }
}

impl From<HostError> for Refusal {
    fn from(error: HostError) -> Self {
        Self::Failed(error.to_string())
    }
}
