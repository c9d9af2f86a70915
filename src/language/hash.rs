//! The `#` commands, one row each (R2.70).
//!
//! A dry run passes over a command without a message where a row names it; any other one is FC210. A row applies to its
//! continuations, `#CS` to `#CS ON`, unless another row names more of the words. Columns that a row leaves out have the
//! values of [`HashCommand::new`]: the command touches nothing that is followed, and is alone in its block.
//!
//! PM/n is page n of the TF5200 programming manual, HSC/n one of the HSC package.

use std::ops::Deref;

use serde::{Deserialize, Deserializer, Serializer};

use super::motion::{
    Certainty, ChainStep, Holds, MotionEffect, MotionKind, Moves, OnOff, Simplification,
};
use super::state::{ChannelState, Mode, RefusedIn};
use crate::readings::Question;

/// A `#` command of the language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct HashCommand {
    /// The words by which it is known, in upper case with one blank between them.
    pub(crate) words: &'static str,
    /// Document that describes it.
    #[allow(dead_code, reason = "it is there to be read")]
    source: &'static str,
    /// Effect on the followed state, apart from the other columns.
    pub(crate) touches: Touches,
    /// Execution in a dry run.
    pub(crate) action: HashAction,
    /// Effect on positions.
    pub(crate) chain: Option<ChainStep>,
    /// Axes that it moves from here on without words of their own.
    pub(crate) motion: Option<MotionEffect>,
    /// Simplification of the commanded trace.
    pub(crate) simplifies: Option<Simplification>,
    /// Reason why the motion of its block is not modelled.
    pub(crate) unmodelled: Option<&'static str>,
    /// Parts that may be in its block.
    pub(crate) sharing: BlockSharing,
    /// Form of the text after its words.
    pub(crate) arguments: HashArguments,
    /// Command that ends what it begins.
    pub(crate) until: Option<&'static str>,
    /// Part of the PLC in it.
    pub(crate) plc: Plc,
    /// Effect on a motion in progress.
    pub(crate) path: PathFlow,
    /// Open question on which its effect rests.
    pub(crate) basis: Option<Question>,
    /// Error of the control for a COMP command up to its end (R2.109).
    pub(crate) refuses_comp: Option<u32>,
    /// Conditions under which it flushes the channel and the control refuses that (R2.111).
    pub(crate) flushes: Flushes,
    /// States in which the control refuses it for another reason (R2.111).
    pub(crate) refused: RefusedIn,
    /// State that it brings until it is switched off.
    pub(crate) brings: Option<ChannelState>,
    /// Mode that it switches, unless it has a word that switches off.
    pub(crate) mode: Option<(Mode, OnOff)>,
    /// Name in the state and in messages, where that is another command's.
    known_as: Option<&'static str>,
}

/// Effect of a `#` command on the followed state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Touches {
    /// No effect on flow or values; the effect on coordinates is that of the chain.
    Nothing,
    /// Write to the parameters and variables that its brackets name.
    Values,
    /// Choice of the axes of the channel and of their names.
    Axes,
    /// Motion of axes to places that are not followed.
    Motion,
    /// Motion of the axes of the plane to places that are not followed.
    Plane,
    /// Friction compensation of the axes that it names, of all where it names none, in a way that no
    /// public page describes (R2.93).
    Friction,
}

/// Execution of a `#` command in a dry run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum HashAction {
    /// No effect but those in the other columns.
    PassOver,
    /// Start of a comment, which consists of the blocks up to its end (PM/205979659).
    Comment,
    /// End of a comment.
    EndComment,
    /// Declaration of variables (PM/207960587).
    Declare,
    /// End of declarations.
    EndDeclarations,
    /// Deletion of variables (PM/207960587).
    Delete,
    /// Initialisation of variables (PM/207988747).
    Initialise,
    /// Dwell (PM/206602507).
    Dwell,
    /// Wait of the program for a condition (R2.99; PM/207058059).
    Wait,
    /// Error that may end the program (R2.100; PM/207457163).
    ReportError,
    /// Start of a loop whose blocks run in real time (tf5261, 783727499).
    RealTimeLoop,
    /// End of a real-time loop.
    EndRealTimeLoop,
    /// Words get programs (PM/207504523).
    NamePrograms,
    /// End of modal cycles (PM/206859019).
    EndModalCycles,
    /// Retention of the changes of the running cycle to G functions and feed (PM/206859019).
    RetainCycleChanges,
    /// Deletion of the macros of the program.
    ForgetMacros,
    /// Start of a description: the blocks up to its end describe geometry and do not move (R2.81): the contour for a
    /// cycle (tf5293, 717505035), a stroke, the limits of an area (tccncprogramming, 15557317259).
    Describe(Described),
    /// End of a description.
    EndDescription,
    /// Definition of a coupling group (PM/207120267).
    DefineCoupling(MembersBy),
    /// Activation of a coupling group (PM/207133579).
    EnableCoupling,
    /// Release of a coupling group (PM/207133579).
    ReleaseCoupling,
    /// Release of all coupling groups (PM/207133579).
    ReleaseCouplings,
    /// Start of blocks that the control may skip while it moves backward or simulates.
    SkipBackward,
    /// Saving or restoring of axes and couplings (PM/207535499).
    SaveConfig(ConfigAction),
    /// Renaming, deletion, writing or search of a file (PM/207511947).
    ChangeFile(FileAction),
    /// Arrival or departure of axes of the channel (PM/206977419 and its neighbours).
    ExchangeAxes(Exchange),
    /// The axes that G200 to G202 of its block are about (PM/206633483).
    NameManualAxes,
    /// Rotation of coordinates in the plane (PM/207442315).
    Rotate,
    /// Programming of overrides (PM/207625099).
    Override,
    /// Change of the main spindle.
    SelectSpindle,
    /// Rounding of transitions between blocks, or its parameters (R11.21).
    Round(ContouringCommand),
    /// Selection of the profile of the acceleration (R11.20).
    SelectSlope(SlopeForm),
    /// Write of an axis parameter while the program runs (R2.92; PM/207492747).
    WriteMachineData,
}

/// What blocks describe that do not move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Described {
    /// The contour for a cycle.
    Contour,
    /// What each motion triggers while strokes are on.
    Stroke,
    /// The limits of an area.
    Area,
}

/// Kind of an axis exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Exchange {
    /// Arrival of the named axes.
    Request,
    /// The named axes go.
    Release,
    /// Arrival of the named axes, and departure of all others.
    Define,
    /// Exchange that no public page describes.
    Undescribed,
}

/// Effect of a command on the saved configurations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ConfigAction {
    Save,
    Load,
    Clear,
}

/// Effect of a command on a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum FileAction {
    Rename,
    Delete,
    /// Write of a message to it.
    Message,
    LookFor,
}

/// Form in which the definition of a coupling group names axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum MembersBy {
    Name,
    /// Logical numbers.
    Number,
}

/// A command that sets the parameters of rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum ContouringCommand {
    /// `#CONTOUR MODE` (PM/475147915).
    Contour,
    /// `#HSC` (PM/207278475).
    HighSpeed,
}

/// Form in which a profile of the acceleration is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum SlopeForm {
    /// Profile of the channel list (PM/207190411).
    Channel,
    /// Profile named (PM/207190411).
    Named,
    /// Profile numbered, in the older command (HSC/15427921547).
    Numbered,
}

/// Content that may share the block with a `#` command (R2.47).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BlockSharing {
    /// No other content.
    None,
    /// Words before it (TF5200 Diagnosis, errors 20207, 20450).
    WordsBefore,
    /// Words before and after it.
    Words,
}

/// Form of the text after the words of a `#` command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum HashArguments {
    /// Brackets and values.
    Brackets,
    /// Expressions.
    Expressions,
    /// Coordinates without a bracket, `#PSET X10 Y20`.
    Coordinates,
    /// The words of `#ERROR`, of which one is the remedy class.
    RemedyClass,
    /// Declarations, up to the end.
    Declarations,
    /// Lines that are not looked at, up to the end.
    Lines,
}

/// Part of the PLC in a `#` command (R2.99).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Plc {
    /// No part.
    Absent,
    /// Action by design: a dwell, a wait. Late M functions are acknowledged at `#EXPL`
    /// (`tf5200_m_and_h_func/286004619`).
    Acts,
    /// Action where the command has the word `WAIT`.
    ActsAfterWait,
    /// Action where the command has the word `ACK` or `SYN_ACK`.
    ActsAfterAcknowledgement,
}

/// State in which the control refuses a command because it flushes the channel (R2.111; PM/524821515, 264720011).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Flushes {
    Never,
    /// Under cutter radius compensation.
    Radius,
    /// Under either.
    Both,
}

impl Flushes {
    /// The states, each with the number of the error.
    pub(crate) fn refused(self) -> RefusedIn {
        const BOTH: RefusedIn = &[
            (ChannelState::CutterRadius, 20651),
            (ChannelState::LeavingRadius, 90050),
            (ChannelState::Spline, 120_434),
        ];
        match self {
            Self::Never => &[],
            Self::Radius => BOTH.split_at(2).0,
            Self::Both => BOTH,
        }
    }
}

/// Effect of a `#` command on a motion in progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum PathFlow {
    /// Possible rest of the axes.
    MayRest,
    /// The axes certainly keep moving.
    GoesOn,
}

impl HashCommand {
    const fn new(words: &'static str, source: &'static str) -> Self {
        Self {
            words,
            source,
            touches: Touches::Nothing,
            action: HashAction::PassOver,
            chain: None,
            motion: None,
            simplifies: None,
            unmodelled: None,
            sharing: BlockSharing::None,
            arguments: HashArguments::Brackets,
            until: None,
            plc: Plc::Absent,
            path: PathFlow::MayRest,
            basis: None,
            refuses_comp: None,
            flushes: Flushes::Never,
            refused: &[],
            brings: None,
            mode: None,
            known_as: None,
        }
    }

    super::columns! {
        touches(touches: Touches) = touches;
        action(action: HashAction) = action;
        chain(step: ChainStep) = Some(step);
        motion(kind: MotionKind, moves: Moves, certainty: Certainty) = Some(MotionEffect { kind, moves, certainty });
        simplifies(what: Simplification) = Some(what);
        unmodelled(reason: &'static str) = Some(reason);
        sharing(sharing: BlockSharing) = sharing;
        arguments(arguments: HashArguments) = arguments;
        until(end: &'static str) = Some(end);
        plc(plc: Plc) = plc;
        path(path: PathFlow) = path;
        basis(question: Question) = Some(question);
        refuses_comp(number: u32) = Some(number);
        flushes(under: Flushes) = under;
        refused(states: RefusedIn) = states;
        brings(state: ChannelState) = Some(state);
        mode(mode: Mode, switch: OnOff) = Some((mode, switch));
        known_as(name: &'static str) = Some(name);
    }
}

macro_rules! commands {
    ($($words:literal ($source:expr) $($column:ident($($value:expr),+))*;)+) => {
        &[$(HashCommand::new($words, $source)$(.$column($($value),+))*),+]
    };
}

/// PM, appendix, overview of additional functions.
const APPENDIX: &str = "PM/5252011631026770315";

/// The commands that the vendor's editor for NC programs supports (isg-stuttgart/vscode-isg-cnc,
/// syntaxes and snippets).
const EDITOR: &str = "vscode-isg-cnc";

/// The texts of the kernel's messages.
const KERNEL: &str = "kernel messages";

/// Coordinate systems are selected or left (TF5200 Diagnosis, page 252599691).
const SYSTEM: RefusedIn = &[(ChannelState::CutterRadius, 20802)];

/// Axes come or go (TF5200 Diagnosis, page 264528523).
const EXCHANGE: RefusedIn = &[(ChannelState::Spline, 120_265)];

/// Positions get other values (TF5200 Diagnosis, pages 251973003, 251981707).
const SET_VALUE: RefusedIn = &[
    (ChannelState::CutterRadius, 20608),
    (ChannelState::Mirror, 20612),
];

/// A coupling group is released (TF5200 Diagnosis, pages 251659659, 264598155, 264602507).
const UNCOUPLE: RefusedIn = &[
    (ChannelState::CutterRadius, 20457),
    (ChannelState::Spline, 120_332),
    (ChannelState::Contouring, 120_333),
];

/// A coupling group comes into force (those, and page 252621451).
const COUPLE: RefusedIn = &[
    (ChannelState::CutterRadius, 20457),
    (ChannelState::Spline, 120_332),
    (ChannelState::Contouring, 120_333),
    (ChannelState::Kinematics, 20809),
];

/// The commands, in the order of their words.
static COMMANDS: &[HashCommand] = {
    use BlockSharing::WordsBefore;
    use Certainty::{Certain, Possible};
    use ChainStep::{Coordinates, Kinematics, Machine, Origin, Path};
    use ChannelState::{CutterRadius, ProgrammedSpline};
    use Flushes::{Both, Radius};
    use HashAction::{
        ChangeFile, Comment, Declare, DefineCoupling, Delete, Describe, Dwell, EnableCoupling,
        EndComment, EndDeclarations, EndDescription, EndModalCycles, EndRealTimeLoop, ExchangeAxes,
        ForgetMacros, Initialise, NameManualAxes, NamePrograms, Override, RealTimeLoop,
        ReleaseCoupling, ReleaseCouplings, ReportError, RetainCycleChanges, Rotate, Round,
        SaveConfig, SelectSlope, SelectSpindle, SkipBackward, Wait, WriteMachineData,
    };
    use HashArguments::{Declarations, Expressions, Lines, RemedyClass};
    use Mode::{BSpline, PointToPoint, Punching};
    use MotionKind::{Coupled, Frame, Independent};
    use Moves::{Channel, Follower, Main, NamedOrAll};
    use OnOff::{Off, On};
    use PathFlow::GoesOn;
    use Question::{AxisExchange, MachineData};
    use Simplification::{
        Contouring, DynamicWeight, FeedGroup, ForeignFeed, HighSpeed, PathLimits, Slope,
    };
    use Touches::{Axes, Friction, Motion, Plane, Values};
    commands! {
        "#ACHSE" ("tccncprogramming/15557317259") action(NameManualAxes) sharing(WordsBefore);
        "#ACHSTAUSCH" (EDITOR) touches(Axes) action(ExchangeAxes(Exchange::Undescribed));
        "#ACS" (APPENDIX) chain(Coordinates) motion(Frame, Main, Possible) refused(SYSTEM) brings(ChannelState::Frame);
        "#ADD" (APPENDIX) sharing(WordsBefore);
        "#AKIMA ENDVECTOR" (APPENDIX);
        "#AKIMA STARTVECTOR" (APPENDIX);
        "#AKIMA TRANS" (APPENDIX);
        "#ANG" ("PM/206123787") touches(Plane) unmodelled("`#ANG` computes a coordinate from an angle");
        "#ASPLINE" (EDITOR);
        "#AX DEF" (APPENDIX) touches(Axes) action(ExchangeAxes(Exchange::Define)) chain(Origin) basis(AxisExchange) flushes(Radius) refused(EXCHANGE);
        "#AX LINK" (APPENDIX) action(DefineCoupling(MembersBy::Name));
        "#AX LINK NBR" (APPENDIX) action(DefineCoupling(MembersBy::Number));
        "#AX LINK OFF" (APPENDIX) action(ReleaseCoupling) refused(UNCOUPLE);
        "#AX LINK OFF ALL" (APPENDIX) action(ReleaseCouplings) refused(UNCOUPLE);
        "#AX LINK ON" (APPENDIX) action(EnableCoupling) refused(COUPLE);
        "#AX LOCK" (APPENDIX);
        "#AX RELEASE" (APPENDIX) touches(Axes) action(ExchangeAxes(Exchange::Release)) basis(AxisExchange) flushes(Radius) refused(EXCHANGE);
        "#AX REQUEST" (APPENDIX) touches(Axes) action(ExchangeAxes(Exchange::Request)) chain(Origin) basis(AxisExchange) flushes(Radius) refused(EXCHANGE);
        "#AX UNLOCK" (APPENDIX);
        "#BACKWARD STORAGE CLEAR" (APPENDIX);
        "#BCS" (APPENDIX) chain(Coordinates) motion(Frame, Main, Possible);
        "#BLOCKSEARCH LOCKED" (APPENDIX);
        "#BLOCKSEARCH RELEASED" (APPENDIX);
        "#BSPLINE" (EDITOR);
        "#CACHE" (APPENDIX);
        "#CALL AX" (APPENDIX) touches(Axes) action(ExchangeAxes(Exchange::Request)) chain(Origin) basis(AxisExchange) flushes(Radius) refused(EXCHANGE);
        "#CAX" (APPENDIX) flushes(Radius);
        "#CAXTRACK" (APPENDIX) motion(Coupled, Follower, Possible);
        "#CHANNEL INIT" (APPENDIX) flushes(Both);
        "#CHANNEL INTERFACE" (APPENDIX);
        "#CHANNEL SET" (APPENDIX);
        "#CHF" (EDITOR) unmodelled("`#CHF`, `#CHR` and `#RND` insert a contour");
        "#CHR" (EDITOR) unmodelled("`#CHF`, `#CHR` and `#RND` insert a contour");
        "#CLAMP" (EDITOR);
        "#CLEAR CONFIG" ("PM/207551115") action(SaveConfig(ConfigAction::Clear)) flushes(Radius);
        "#COMMAND WAIT" (EDITOR);
        "#COMMAND WR" (EDITOR);
        "#COMMENT" ("PM/205979659") path(GoesOn);
        "#COMMENT BEGIN" ("PM/205979659") action(Comment) until("#COMMENT END") path(GoesOn);
        "#COMMENT END" ("PM/205979659") action(EndComment) path(GoesOn);
        "#CONTOUR BEGIN" (EDITOR) action(Describe(Described::Contour)) until("#CONTOUR END") refuses_comp(22101);
        "#CONTOUR END" (EDITOR) action(EndDescription);
        "#CONTOUR MODE" ("tccncprogramming/15557317259") action(Round(ContouringCommand::Contour)) simplifies(Contouring);
        "#CONTROL AREA" ("tccncprogramming/15557317259");
        "#CONTROL AREA BEGIN" ("tccncprogramming/15557317259") action(Describe(Described::Area)) until("#CONTROL AREA END");
        "#CONTROL AREA END" ("tccncprogramming/15557317259") action(EndDescription);
        "#CORNER PARAM" (EDITOR);
        "#CS" (EDITOR) chain(Coordinates) motion(Frame, Main, Possible) flushes(Both) refused(SYSTEM) brings(ChannelState::Frame);
        "#CYL" (EDITOR) chain(Coordinates) motion(Frame, Channel, Possible) flushes(Radius);
        "#DB INFO" (EDITOR);
        "#DCC" (EDITOR);
        "#DEL DIST2GO" (EDITOR);
        "#DELETE" ("PM/207960587") action(Delete) arguments(Expressions);
        "#DISABLE AX LINK" ("PM/207133579") action(ReleaseCoupling) refused(UNCOUPLE);
        "#DISABLE AX LINK ALL" ("PM/207133579") action(ReleaseCouplings) refused(UNCOUPLE);
        "#DISABLE MODAL CYCLE" ("PM/206859019") action(EndModalCycles);
        "#DIST CTRL" (EDITOR);
        "#DIST CTRL ON" (EDITOR) motion(Independent, NamedOrAll, Possible);
        "#DIST TO GO" (EDITOR);
        "#DISTANCE PROG START" (EDITOR);
        "#DRIVE RD" (EDITOR) touches(Values);
        "#DRIVE WAIT" (EDITOR);
        "#DRIVE WR" (EDITOR);
        "#DYN WEIGHT" (EDITOR) simplifies(DynamicWeight);
        "#DYNAMIC WEIGHT" (EDITOR) simplifies(DynamicWeight);
        "#DYN_WEIGHT" (EDITOR) simplifies(DynamicWeight);
        "#ECS" (EDITOR) chain(Coordinates) motion(Frame, Main, Possible);
        "#EDGE MACHINING" (EDITOR);
        "#EDM" (EDITOR);
        "#ENABLE AX LINK" ("PM/207133579") action(EnableCoupling) refused(COUPLE);
        "#ENDVAR" ("PM/207960587") action(EndDeclarations) path(GoesOn);
        "#ERROR" (EDITOR) action(ReportError) arguments(RemedyClass);
        "#EXPL SYN" (EDITOR) plc(Plc::Acts);
        "#EXPORT VE" (EDITOR);
        "#EXTCOMP" (EDITOR);
        "#FACE" (EDITOR) chain(Coordinates) motion(Frame, Channel, Possible) flushes(Radius);
        "#FF" (EDITOR) simplifies(ForeignFeed);
        "#FGROUP" (EDITOR) simplifies(FeedGroup);
        "#FILE DELETE" ("PM/207518603") action(ChangeFile(FileAction::Delete));
        "#FILE EXIST" ("PM/207524491") action(ChangeFile(FileAction::LookFor));
        "#FILE NAME" ("FCT-C18") action(NamePrograms);
        "#FILE RENAME" ("PM/207511947") action(ChangeFile(FileAction::Rename));
        "#FILENAME" ("FCT-C18") action(NamePrograms);
        "#FILTER" (EDITOR);
        "#FLUSH" (EDITOR) plc(Plc::ActsAfterWait) flushes(Both);
        "#FRC" (EDITOR);
        "#FREE TOOL CHANGE" (EDITOR);
        // Named only by the kernel's messages 21721, 50758, 70496 and 70497.
        "#FRICTION" (KERNEL) touches(Friction);
        "#GANTRY" (EDITOR) motion(Coupled, Moves::Gantry, Certain);
        "#GEAR LINK" ("PM/546229387") motion(Coupled, Follower, Certain);
        "#GEO" (EDITOR) simplifies(ForeignFeed);
        "#GET ACTPOS" (EDITOR) touches(Values) flushes(Radius);
        "#GET CMDPOS" (EDITOR) touches(Values) flushes(Radius);
        "#GET IPO OFFSET" (EDITOR) touches(Values);
        "#GET MANUAL OFFSETS" (EDITOR) touches(Values) flushes(Radius);
        "#GET WCS POSLIMIT" (EDITOR) touches(Values);
        "#HANDWHEEL" (EDITOR);
        "#HSC" (EDITOR) action(Round(ContouringCommand::HighSpeed)) simplifies(HighSpeed);
        "#HSC ON" ("PM/207278475") action(Round(ContouringCommand::HighSpeed)) simplifies(HighSpeed) refused(&[(ProgrammedSpline, 120_255)]) known_as("#HSC");
        "#IDENT RD" (EDITOR) touches(Values);
        "#IDENT WR" (EDITOR);
        "#INFO" (EDITOR);
        "#INIT" (EDITOR) touches(Values) action(Initialise);
        "#INIT MACRO TAB" (EDITOR) action(ForgetMacros);
        "#INIT V" (EDITOR) touches(Values);
        "#JOG CONT" (EDITOR);
        "#JOG INCR" (EDITOR);
        "#KIN DATA" (EDITOR) chain(Kinematics) known_as("#KIN") motion(Frame, Channel, Possible);
        "#KIN ID" (EDITOR) chain(Kinematics) known_as("#KIN") motion(Frame, Channel, Possible) refused(&[(ChannelState::Kinematics, 20687)]);
        "#KIN TCP" (EDITOR);
        "#LAH" (EDITOR);
        "#LASER" (EDITOR);
        "#LIMIT LOAD" (EDITOR);
        "#LIMIT REFRESH" (EDITOR);
        "#LOAD CONFIG" ("PM/207542155") touches(Axes) action(SaveConfig(ConfigAction::Load)) flushes(Radius) refused(&[(ChannelState::Coupling, 21277)]);
        "#LOCK" (EDITOR);
        "#MACHINE DATA" (EDITOR) action(WriteMachineData) basis(MachineData);
        "#MAIN SPINDLE" (EDITOR) action(SelectSpindle);
        "#MANUAL LIMITS" (EDITOR);
        "#MARK" (EDITOR);
        "#MCS" (EDITOR) chain(Machine) flushes(Radius) refused(SYSTEM);
        "#MCS TO WCS" ("PM/208525707") touches(Values) flushes(Radius);
        "#MC_MOVEPATH" (EDITOR) touches(Motion);
        "#MEAS" (EDITOR);
        "#MICROJOINT" (EDITOR);
        "#MSG" (EDITOR) plc(Plc::ActsAfterAcknowledgement) path(GoesOn);
        "#MSG SAVE" ("PM/207518603") action(ChangeFile(FileAction::Message)) plc(Plc::ActsAfterAcknowledgement) path(GoesOn);
        "#NIBBLE" (EDITOR) mode(Punching, On);
        "#OPTIONAL EXECUTION" (EDITOR) action(SkipBackward);
        "#ORI MODE" (EDITOR);
        "#ORIMODE" (EDITOR);
        "#OTC" (EDITOR);
        "#OTC OFF" ("PM/524821515") flushes(Radius);
        "#OVERRIDE" (EDITOR) action(Override);
        "#PRESET" (EDITOR) chain(Origin) sharing(WordsBefore) arguments(HashArguments::Coordinates) flushes(Radius) refused(SET_VALUE);
        "#PSET" (EDITOR) chain(Origin) sharing(WordsBefore) arguments(HashArguments::Coordinates) refused(SET_VALUE);
        "#PTP" (EDITOR) mode(PointToPoint, On) flushes(Radius) refused(&[(CutterRadius, 21525)]);
        "#PUNCH" (EDITOR) mode(Punching, On);
        "#PUT AX" (EDITOR) touches(Axes) action(ExchangeAxes(Exchange::Release)) basis(AxisExchange) flushes(Radius) refused(EXCHANGE);
        "#RETAIN CYCLE CHANGES" ("PM/206859019") action(RetainCycleChanges);
        "#RND" (EDITOR) unmodelled("`#CHF`, `#CHR` and `#RND` insert a contour");
        "#ROTATION" (EDITOR) action(Rotate) chain(Coordinates) motion(Frame, Moves::Plane, Certain);
        "#RT CYCLE" (EDITOR) arguments(Lines) until("#RT CYCLE END");
        "#RT CYCLE DEF" (EDITOR) arguments(Lines) until("#RT CYCLE END");
        "#RT CYCLE END" (EDITOR);
        "#RT ENDWHILE" (EDITOR) action(EndRealTimeLoop);
        "#RT WHILE" (EDITOR) action(RealTimeLoop) refused(&[(CutterRadius, 22158)]);
        "#RTCP" (EDITOR) chain(Coordinates) motion(Frame, Channel, Possible) brings(ChannelState::Kinematics);
        "#SAVE CONFIG" ("PM/207535499") action(SaveConfig(ConfigAction::Save));
        "#SCALE" (EDITOR) chain(Coordinates);
        "#SCENE" (EDITOR);
        "#SEGMENTATION" (EDITOR);
        "#SET ASPLINE" (EDITOR);
        "#SET AX" (EDITOR) touches(Axes) action(ExchangeAxes(Exchange::Define)) chain(Origin) basis(AxisExchange) flushes(Radius) refused(EXCHANGE);
        "#SET AX LINK" (EDITOR) action(DefineCoupling(MembersBy::Name)) flushes(Radius);
        "#SET AX LINK NBR" (EDITOR) action(DefineCoupling(MembersBy::Number)) flushes(Radius);
        "#SET CORNER PARAM" (EDITOR);
        "#SET DEC LR SOLL" (EDITOR) flushes(Both);
        "#SET HR" (EDITOR);
        "#SET IPO SOLLPOS" (EDITOR) chain(Origin) flushes(Both);
        "#SET JOG" (EDITOR);
        "#SET OFFSET" (EDITOR) chain(Origin);
        "#SET PATH SMOOTH" (EDITOR);
        "#SET SLOPE" (EDITOR) simplifies(Slope);
        "#SET SLOPE PROFIL" (EDITOR) action(SelectSlope(SlopeForm::Numbered)) simplifies(Slope);
        "#SET SPLINE" (EDITOR) chain(Path) known_as("#SPLINE") refused(&[(ChannelState::HighSpeed, 120_370)]);
        "#SET SPLINETYPE" (EDITOR);
        "#SET TANGFEED RMIN" (EDITOR);
        "#SET TIP" (EDITOR);
        "#SET UEBERSCH_PARAM" (EDITOR);
        "#SHIFT" (EDITOR) chain(Origin) arguments(HashArguments::Coordinates);
        "#SIGNAL" (EDITOR);
        "#SIGNAL READ" ("PM/913718283") touches(Values);
        "#SINGLE STEP" (EDITOR);
        "#SLOPE" (EDITOR) action(SelectSlope(SlopeForm::Named)) simplifies(Slope);
        "#SLOPE DEFAULT" ("PM/207190411") action(SelectSlope(SlopeForm::Channel)) simplifies(Slope);
        "#SPLINE" (EDITOR) chain(Path) refused(&[(ChannelState::HighSpeed, 120_370)]);
        "#SPLINE TYPE" ("PM/207203723");
        "#SPLINE TYPE AKIMA" ("PM/207203723") mode(BSpline, Off);
        "#SPLINE TYPE BSPLINE" ("PM/207203723") mode(BSpline, On);
        "#START" (EDITOR);
        "#STOP REVERSIBLE" (EDITOR);
        "#STROKE DEF" (EDITOR);
        "#STROKE DEF BEGIN" (EDITOR) action(Describe(Described::Stroke)) until("#STROKE DEF END") refuses_comp(120_716);
        "#STROKE DEF END" (EDITOR) action(EndDescription);
        "#SUPPRESS OFFSETS" (EDITOR) chain(Origin) sharing(WordsBefore);
        "#SURFACE" (EDITOR);
        // With the conveyor all axes follow it (965255691).
        "#SYNC" (EDITOR) touches(Motion) chain(Coordinates);
        "#SYNC IN" ("965255691") touches(Motion) chain(Coordinates) known_as("#SYNC") motion(Coupled, NamedOrAll, Possible);
        "#TANGFEED" (EDITOR);
        "#TGC" (EDITOR);
        "#TIME" ("PM/206602507") action(Dwell) plc(Plc::Acts) arguments(Expressions);
        "#TIMER" (EDITOR) touches(Values);
        "#TLAX" (EDITOR);
        "#TLC" (EDITOR) chain(Coordinates);
        "#TLC ON" (EDITOR) chain(Coordinates) known_as("#TLC") refused(&[(CutterRadius, 20671)]);
        "#TOOL AX" (EDITOR);
        "#TOOL DATA" (EDITOR);
        "#TOOL DEF" (EDITOR);
        "#TOOL LIFE DEF" (EDITOR);
        "#TOOL LIFE READ" (EDITOR) touches(Values);
        "#TOOL LIFE REMOVE" (EDITOR);
        "#TOOL ORI CS" (EDITOR);
        "#TOOL PREP" (EDITOR);
        "#TOOL REFRESH" (EDITOR);
        "#TRACK CHAN" (EDITOR);
        "#TRACK CS" (EDITOR) chain(Coordinates) motion(Frame, Main, Possible) flushes(Radius);
        "#TRAFO" (EDITOR) chain(Coordinates) motion(Frame, Channel, Possible) flushes(Both) brings(ChannelState::Kinematics);
        "#TRAFO ON" (EDITOR) chain(Coordinates) motion(Frame, Channel, Possible) flushes(Both) known_as("#TRAFO") refused(&[(ChannelState::PointToPoint, 21552)]) brings(ChannelState::Kinematics);
        "#TRANSFORM" (EDITOR) chain(Coordinates) motion(Frame, Channel, Possible);
        "#TRANSVELMIN" (EDITOR);
        "#TRC" (EDITOR);
        "#TURN" (EDITOR);
        "#UNLOCK" (EDITOR);
        "#VAR" ("PM/207960587") action(Declare) arguments(Declarations) until("#ENDVAR") path(GoesOn);
        "#VECTOR LIMIT" (EDITOR) simplifies(PathLimits);
        "#VECTOR OFFSET" (EDITOR);
        "#VECTORACC" (EDITOR) simplifies(PathLimits);
        "#VECTORVEL" (EDITOR) simplifies(PathLimits);
        "#VIB GUARD" (EDITOR);
        "#VIRTUAL AX" (EDITOR);
        "#VOLCOMP" (EDITOR);
        "#VOLKOMP" (EDITOR);
        "#WAIT" ("PM/207421579") touches(Values) plc(Plc::Acts);
        "#WAIT FOR" (EDITOR) action(Wait) plc(Plc::Acts) arguments(Expressions);
        "#WAIT INDP" (EDITOR) plc(Plc::Acts);
        "#WAIT MC_STATUS" ("ISG/1139940235") plc(Plc::Acts);
        "#WCS TO MCS" ("PM/208525707") touches(Values) flushes(Radius);
    }
};

crate::words! {
    /// A word that follows the name of a `#` command or its bracket, `#MSG SAVE EXCLUSIVE […]`, `#SET AX […] FAST`
    /// (vscode-isg-cnc; PM, chapters of the commands).
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    #[allow(missing_docs, reason = "each is its own word")]
    pub(crate) enum FurtherWord {
        Abs = "ABS",
        Ack = "ACK",
        Act = "ACT",
        Adapt = "ADAPT",
        Add = "ADD",
        Akima = "AKIMA",
        All = "ALL",
        Begin = "BEGIN",
        Bspline = "BSPLINE",
        Clear = "CLEAR",
        Continue = "CONTINUE",
        Def = "DEF",
        Default = "DEFAULT",
        Del = "DEL",
        Delay = "DELAY",
        Delete = "DELETE",
        Disable = "DISABLE",
        Enable = "ENABLE",
        End = "END",
        Ex = "EX",
        Exclusive = "EXCLUSIVE",
        Fast = "FAST",
        Feed = "FEED",
        Get = "GET",
        Hmi = "HMI",
        Idx = "IDX",
        In = "IN",
        Info = "INFO",
        Init = "INIT",
        Lateral = "LATERAL",
        Load = "LOAD",
        Mode = "MODE",
        Nam = "NAM",
        Nbr = "NBR",
        Off = "OFF",
        Offsets = "OFFSETS",
        On = "ON",
        Ori = "ORI",
        Out = "OUT",
        Pcs = "PCS",
        Profile = "PROFILE",
        Read = "READ",
        Remove = "REMOVE",
        Rot = "ROT",
        Save = "SAVE",
        Select = "SELECT",
        Set = "SET",
        Start = "START",
        Stop = "STOP",
        Syn = "SYN",
        SynAck = "SYN_ACK",
        Tool = "TOOL",
        Type = "TYPE",
        Wait = "WAIT",
        Waxis = "WAXIS",
    }
}

/// The further words of a command, a bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) struct FurtherWords(u64);

/// A `#` command in a program: its row, and the further words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct HashWords {
    command: &'static HashCommand,
    further: FurtherWords,
}

impl FurtherWord {
    /// Returns the word, in either case.
    pub(crate) fn of(word: &str) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|known| known.as_str().eq_ignore_ascii_case(word))
    }
}

impl HashWords {
    /// Returns the command of a name, in upper case with one blank between its words; `None` where no row names it.
    pub(crate) fn of(name: &str) -> Option<Self> {
        let command = HashCommand::of(name)?;
        let further = name[command.words.len()..].split_ascii_whitespace();
        let further = further
            .filter_map(FurtherWord::of)
            .fold(0, |set, word| set | 1 << word as u64);
        Some(Self {
            command,
            further: FurtherWords(further),
        })
    }

    /// Returns whether it has a further word.
    pub(crate) fn has(self, word: FurtherWord) -> bool {
        self.further.0 & 1 << word as u64 != 0
    }

    /// Returns whether its words are only those of its row.
    pub(crate) fn is_plain(self) -> bool {
        self.further == FurtherWords::default()
    }

    /// Returns the command up to which the lines after it are its text; none with a further word, `#RT CYCLE END`.
    pub(crate) fn region_end(self) -> Option<&'static str> {
        let has_region = matches!(
            self.arguments,
            HashArguments::Declarations | HashArguments::Lines
        );
        self.until.filter(|_| has_region && self.is_plain())
    }

    /// Returns the row of the command in the table.
    pub(crate) fn row(self) -> &'static HashCommand {
        self.command
    }

    /// Returns whether it switches off.
    pub(crate) fn is_off(self) -> bool {
        let words = [FurtherWord::Off, FurtherWord::Del, FurtherWord::Out];
        words.into_iter().any(|word| self.has(word))
    }

    /// Returns the simplification that it brings, and how long. `#CONTOUR MODE` without ON or OFF only sets parameters
    /// (PM/475156491).
    pub(crate) fn simplification(self) -> Option<(Simplification, Holds)> {
        let what = self.simplifies?;
        if self.has(FurtherWord::Off) {
            return Some((what, Holds::Off));
        }
        let only_parameters = what == Simplification::Contouring && !self.has(FurtherWord::On);
        (!only_parameters).then_some((what, Holds::On))
    }

    /// Returns whether the PLC acts by design in it.
    pub(crate) fn lets_plc_act(self) -> bool {
        match self.plc {
            Plc::Absent => false,
            Plc::Acts => true,
            Plc::ActsAfterWait => self.has(FurtherWord::Wait),
            Plc::ActsAfterAcknowledgement => {
                self.has(FurtherWord::Ack) || self.has(FurtherWord::SynAck)
            }
        }
    }
}

impl Deref for HashWords {
    type Target = HashCommand;

    fn deref(&self) -> &HashCommand {
        self.command
    }
}

impl HashCommand {
    /// Returns the row that names the most words of a name.
    pub(crate) fn of(name: &str) -> Option<&'static Self> {
        let mut words = name;
        loop {
            if let Some(row) = Self::with(words) {
                return Some(row);
            }
            (words, _) = words.rsplit_once(' ')?;
        }
    }

    /// Returns the row with these words.
    fn with(words: &str) -> Option<&'static Self> {
        let place = COMMANDS.binary_search_by(|row| row.words.cmp(words)).ok()?;
        COMMANDS.get(place)
    }

    /// Returns the row of a name in the state.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        let by_alias = || COMMANDS.iter().find(|row| row.known_as == Some(name));
        let is_command = name.starts_with('#');
        is_command.then(|| Self::with(name).or_else(by_alias))?
    }

    /// Returns the words of every row.
    pub(crate) fn all_words() -> impl Iterator<Item = &'static str> {
        COMMANDS.iter().map(|row| row.words)
    }

    /// Returns its name in the state and in messages.
    pub(crate) fn name(&self) -> &'static str {
        self.known_as.unwrap_or(self.words)
    }

    /// Returns whether a dry run follows what is in its brackets.
    pub(crate) fn reads_brackets(&self) -> bool {
        self.arguments == HashArguments::Brackets
            && (self.action != HashAction::PassOver
                || self.motion.is_some()
                || self.touches == Touches::Friction)
    }
}

impl serde::Serialize for HashCommand {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.words)
    }
}

impl<'de> Deserialize<'de> for &'static HashCommand {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let words = String::deserialize(deserializer)?;
        let row = HashCommand::with(&words);
        row.ok_or_else(|| serde::de::Error::custom("not a command of the language"))
    }
}

/// Returns whether a name is that of a known command.
pub(crate) fn is_command(name: &str) -> bool {
    HashCommand::of(name).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rows_are_in_order_and_whole() {
        // R2.70
        for pair in COMMANDS.windows(2) {
            assert!(pair[0].words < pair[1].words, "{}", pair[1].words);
        }
        for row in COMMANDS {
            let ends = row.until.is_none_or(|end| HashCommand::with(end).is_some());
            let is_named = HashCommand::named(row.name()).is_some();
            assert!(ends && is_named && !row.source.is_empty(), "{}", row.words);
        }
    }

    #[test]
    fn commands_are_told_apart_by_their_words() {
        // R2.47 R2.82
        let of = |name| {
            let command = HashWords::of(name)?;
            command.chain.map(|_| (command.name(), command.is_off()))
        };
        assert_eq!(of("#MCS ON"), Some(("#MCS", false)));
        assert_eq!(of("#MCS ON EX TOOL"), Some(("#MCS", false)));
        assert_eq!(of("#MCS OFF"), Some(("#MCS", true)));
        assert_eq!(of("#MCS TO WCS"), None);
        assert_eq!(of("#CS DEL ALL"), Some(("#CS", true)));
        assert_eq!(of("#CSX ON"), None);
        assert_eq!(of("#SPLINE OFF X10"), Some(("#SPLINE", true)));
        assert_eq!(of("#SET SPLINE ON"), Some(("#SPLINE", false)));
        assert_eq!(of("#SET SPLINETYPE AKIMA"), None);
        assert_eq!(of("#SET AX LINK"), None);
        assert_eq!(of("#SYNC IN"), Some(("#SYNC", false)));
        assert_eq!(of("#SYNC OUT"), Some(("#SYNC", true)));
        assert_eq!(of("#KIN ID"), Some(("#KIN", false)));
        assert_eq!(of("#KIN TCP DEF"), None);
    }

    #[test]
    fn what_a_command_brings_depends_on_its_further_words() {
        // R5.1 R10.7
        let brings = |name| HashWords::of(name).and_then(HashWords::simplification);
        assert_eq!(brings("#CONTOUR MODE"), None);
        let contouring = Simplification::Contouring;
        assert_eq!(brings("#CONTOUR MODE ON"), Some((contouring, Holds::On)));
        assert_eq!(brings("#CONTOUR MODE OFF"), Some((contouring, Holds::Off)));
        assert_eq!(brings("#HSCX"), None);
        let moves = |name| {
            HashWords::of(name)?
                .motion
                .map(|it| (it.kind, it.certainty))
        };
        let rotated = (MotionKind::Frame, Certainty::Certain);
        assert_eq!(moves("#ROTATION ON"), Some(rotated));
        assert_eq!(moves("#SYNC OUT"), None);
        let regions = |name| HashWords::of(name).and_then(HashWords::region_end);
        assert_eq!(regions("#RT CYCLE DEF"), Some("#RT CYCLE END"));
        assert_eq!(regions("#RT CYCLE DELETE"), None);
    }
}
