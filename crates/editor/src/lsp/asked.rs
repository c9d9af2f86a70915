//! The requests of the server to the client.

use gen_lsp_types::{
    ConfigurationItem, ConfigurationParams, ConfigurationRequest,
    DidChangeWatchedFilesRegistrationOptions, FileSystemWatcher, Registration, RegistrationParams,
    RegistrationRequest, Request as _,
};
use lsp_server::{Outgoing, Request};
use serde_json::json;

use frictcomp_host::CONFIG_NAME;

/// Request of the server that the client has not answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ServerRequest {
    /// The settings of the user.
    Settings,
    /// Reports of changed files.
    NewsOfFiles,
    /// A repeated request for what is shown.
    Refresh,
}

impl ServerRequest {
    /// Returns the consequence of a refusal by the client.
    pub(super) fn refused(self) -> &'static str {
        match self {
            Self::Settings => "the client does not give its settings",
            Self::NewsOfFiles => "the client does not report changed files",
            Self::Refresh => "the client does not refresh what is shown",
        }
    }
}

/// Requests the settings of the user.
pub(super) fn settings(outgoing: &mut Outgoing<ServerRequest>) -> Request {
    let params = ConfigurationParams::new(vec![ConfigurationItem {
        scope_uri: None,
        section: Some("frictcomp".to_owned()),
    }]);
    let method = ConfigurationRequest::METHOD.to_string();
    outgoing.register(method, params, ServerRequest::Settings)
}

/// Requests notices of changed lists, configurations and programs.
pub(super) fn news_of_files(outgoing: &mut Outgoing<ServerRequest>) -> Request {
    let endings =
        "nc,NC,cnc,CNC,mpf,MPF,spf,SPF,cyc,CYC,sub,SUB,iso,ISO,ngc,NGC,tap,TAP,plc,PLC,lis,LIS";
    let programs = format!("**/*.{{{endings}}}");
    let patterns = [programs, format!("**/{CONFIG_NAME}")];
    let watchers = patterns.map(|pattern| FileSystemWatcher {
        glob_pattern: pattern.into(),
        kind: None,
    });
    let options = DidChangeWatchedFilesRegistrationOptions::new(watchers.to_vec());
    let params = RegistrationParams::new(vec![Registration {
        id: "files".to_owned(),
        method: "workspace/didChangeWatchedFiles".to_owned(),
        register_options: Some(json!(options)),
    }]);
    let method = RegistrationRequest::METHOD.to_string();
    outgoing.register(method, params, ServerRequest::NewsOfFiles)
}
