//! `#SAVE CONFIG`, `#LOAD CONFIG`, `#CLEAR CONFIG` (R2.107; PM/207535499, PM/207542155, PM/207551115).

use crate::comp::AxisIndex;
use crate::diagnostic::Code;
use crate::interpreter::run::block_context::BlockContext;
use crate::interpreter::run::control::ControlState;
use crate::interpreter::run::executor::Executor;
use crate::interpreter::run::saved_config::{SavedConfig, SavedItem};
use crate::language::ConfigAction;
use crate::syntax::Fault;
use crate::syntax::ast::Hash;

/// The group in which saved couplings are restored.
const RESTORED_GROUP: &str = "1";

impl Executor {
    /// Executes a command of saved configurations.
    pub(crate) fn saved_config(
        &mut self,
        action: ConfigAction,
        hash: &Hash,
        at: &BlockContext<'_>,
    ) -> Result<(), Box<Fault>> {
        self.state.control.modal.hash(hash.command);
        self.pass_over(hash.command.words, hash.span, at);
        let [axes, links] = ["AX", "AXLINK"].map(|word| hash.brackets.has(word, at.text));
        match action {
            ConfigAction::Clear => {
                self.state.control.saved = SavedConfig {
                    axes: SavedItem::Nothing,
                    links: SavedItem::Nothing,
                };
            }
            // Without a word both are meant.
            ConfigAction::Save if !axes && !links => self.state.control.save_config(true, true),
            ConfigAction::Save => self.state.control.save_config(axes, links),
            ConfigAction::Load => {
                let is_both = !axes && !links;
                let saved = &self.state.control.saved;
                let [no_axes, no_links] = [
                    saved.axes == SavedItem::Nothing,
                    saved.links == SavedItem::Nothing,
                ];
                if axes || is_both && !no_axes {
                    self.load_axes(hash, at)?;
                }
                if links || is_both && !no_links {
                    self.load_links(hash, at)?;
                }
            }
        }
        Ok(())
    }

    fn load_axes(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        match self.state.control.saved.axes.clone() {
            SavedItem::Known(axes) => self.state.control.channel_axes = axes,
            SavedItem::Nothing => {
                let what = "no axes are saved, and the control refuses to restore them";
                return Err(Fault::refused(Code::PErr21274, hash.span, what));
            }
            SavedItem::Perhaps => {
                let what =
                    "which axes are restored here is not known: no program of this run saved them";
                self.may_refuse(21274, what, hash.span, at);
                self.state.control.havoc_exchange();
            }
        }
        Ok(())
    }

    fn load_links(&mut self, hash: &Hash, at: &BlockContext<'_>) -> Result<(), Box<Fault>> {
        match self.state.control.saved.links.clone() {
            SavedItem::Known(axes) => {
                self.release_couplings();
                self.restore_couplings(RESTORED_GROUP, axes);
            }
            SavedItem::Nothing => {
                let what = "no couplings are saved, and the control refuses to restore them";
                return Err(Fault::refused(Code::PErr21275, hash.span, what));
            }
            SavedItem::Perhaps => {
                let what = "which couplings are restored here is not known: no program of this run saved them";
                self.may_refuse(21275, what, hash.span, at);
                self.couple_any();
            }
        }
        Ok(())
    }

    /// Any axes may be coupled.
    pub(crate) fn couple_any(&mut self) {
        let all = (0..self.machine.axes.len()).map(AxisIndex::new).collect();
        let changed = self.state.control.couplings.define(RESTORED_GROUP, all);
        self.state.control.mark_coupled(changed);
        self.havoc_couplings();
    }
}

impl ControlState {
    fn save_config(&mut self, axes: bool, links: bool) {
        if axes {
            self.saved.axes = if self.channel_axes.doubtful {
                SavedItem::Perhaps
            } else {
                SavedItem::Known(self.channel_axes.clone())
            };
        }
        if links {
            self.saved.links = match self.couplings.in_force() {
                Some(axes) if axes.is_empty() => SavedItem::Nothing,
                Some(axes) => SavedItem::Known(axes),
                None => SavedItem::Perhaps,
            };
        }
    }
}
