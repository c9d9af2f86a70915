//! The snapshot from which a request is answered: the texts and the results of their checks at one
//! moment.

use std::sync::Arc;

use gen_lsp_types::{Position, Uri};

use super::analysis::{Analysis, ProgramRun};
use super::client::LspClient;
use super::documents::{Documents, OpenDocument};
use super::messages::{MessagesByUri, Translator};
use super::project_calls::ProjectCalls;
use super::worker::Cancel;
use frictcomp::text::shown_path;
use frictcomp_host::SharedMap;

/// Snapshot from which a request is answered. A copy is cheap, and does not change.
#[derive(Clone)]
pub(super) struct RequestView {
    /// The client.
    pub(super) client: Arc<LspClient>,
    /// Open documents.
    pub(super) documents: Documents,
    /// Results of the checks of the open texts, by their URIs.
    pub(super) analyses: SharedMap<String, Arc<Analysis>>,
    /// Messages on the texts, by their URIs.
    pub(super) shown: MessagesByUri,
    /// Calls between the programs of the project.
    pub(super) calls: ProjectCalls,
    /// Mark that the client no longer waits for the answer.
    pub(super) cancel: Cancel,
}

impl RequestView {
    /// Returns the source of the messages to the client.
    pub(super) fn translator(&self) -> Translator<'_> {
        Translator {
            client: &self.client,
            documents: &self.documents,
        }
    }

    /// Returns the result of the check of an open text.
    pub(super) fn analysis(&self, uri: &Uri) -> Option<&Analysis> {
        self.analyses.get(&uri.0).map(AsRef::as_ref)
    }

    /// Returns an open text.
    pub(super) fn document(&self, uri: &Uri) -> Option<&OpenDocument> {
        self.documents.get(uri).map(AsRef::as_ref)
    }

    /// Returns the results of the checks of a text, and of others that use it, in the order of
    /// their URIs.
    pub(super) fn analyses_of(&self, document: &OpenDocument) -> Vec<(&str, &Analysis)> {
        let analyses = self.analyses.iter();
        let analyses = analyses.map(|(uri, analysis)| (uri.as_str(), analysis.as_ref()));
        let mut using: Vec<_> = analyses
            .filter(|(uri, it)| *uri == document.uri.0 || it.reads.contains(&document.path))
            .collect();
        using.sort_unstable_by_key(|(uri, _)| *uri);
        using
    }

    /// Returns the runs that executed a file, each with the name of the file there: the run of the file itself first,
    /// then those of programs that call it.
    pub(super) fn runs(
        &self,
        document: &OpenDocument,
    ) -> Vec<(&OpenDocument, &ProgramRun, String)> {
        let name = shown_path(&document.path);
        let mut runs = Vec::new();
        for (uri, analysis) in self.analyses_of(document) {
            let (Some(run), Some(main)) = (&analysis.run, self.document(&Uri(uri.to_owned())))
            else {
                continue;
            };
            if main.uri == document.uri {
                runs.insert(0, (main, run, name.clone()));
            } else if run.states.has(&name) {
                runs.push((main, run, name.clone()));
            }
        }
        runs
    }

    /// Returns the line, from 1, of the block at a position.
    pub(super) fn block_at(document: &OpenDocument, position: Position) -> u32 {
        document.block_line(position.line).saturating_add(1)
    }
}
