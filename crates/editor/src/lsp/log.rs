//! Messages for the log of the editor.

use gen_lsp_types::{LogMessageNotification, LogMessageParams, MessageType, Notification as _};
use lsp_server::{Message, Notification};

/// Creates a message about something that went wrong between client and server.
pub(super) fn log(message: String) -> Message {
    let params = LogMessageParams {
        kind: MessageType::Warning,
        message,
    };
    Notification::new(LogMessageNotification::METHOD.to_string(), params).into()
}
