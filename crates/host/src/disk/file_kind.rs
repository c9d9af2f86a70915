//! The kind of a file by its name: a program, a list, a configuration.

use std::path::Path;

/// The name of a configuration.
pub const CONFIG_NAME: &str = "frictcomp.toml";

/// Extensions of NC programs, in lower case.
pub(crate) const EXTENSIONS: [&str; 10] = [
    "nc", "cnc", "mpf", "spf", "sub", "cyc", "iso", "ngc", "tap", "plc",
];

/// Extensions of documents, sources, data, settings, pictures and archives, none of which is read in search of programs.
/// An `.ecy` is encrypted.
const OTHER_EXTENSIONS: &[&str] = &[
    "3mf", "7z", "a", "adoc", "asm", "awl", "bash", "bat", "bib", "bmp", "bz2", "c", "cc", "cfg",
    "class", "cmake", "cmd", "conf", "contour", "cpp", "cs", "css", "csv", "cxx", "db", "diff",
    "dll", "doc", "docx", "dxf", "ecy", "eni", "esi", "exe", "exp", "gif", "go", "gz", "hpp",
    "htm", "html", "ico", "iges", "igs", "ini", "ipynb", "jar", "java", "jpeg", "jpg", "js",
    "json", "jsonl", "jsx", "kt", "less", "lib", "library", "lis", "lock", "log", "lua", "m",
    "map", "markdown", "md", "mjs", "mp4", "ndjson", "o", "obj", "ods", "odt", "org", "patch",
    "pdf", "php", "pickle", "pl", "plcproj", "png", "ppt", "pptx", "project", "ps1", "py", "pyc",
    "pyi", "r", "rar", "rb", "rej", "rs", "rst", "rtf", "s", "sarif", "scl", "scss", "sh", "sln",
    "snap", "so", "sql", "sqlite", "st", "step", "stl", "stp", "svdx", "svg", "swift", "tar",
    "tcdut", "tcgvl", "tcpou", "tcscopex", "tex", "tgz", "timeline", "toml", "ts", "tsproj", "tsv",
    "tsx", "vb", "whl", "xml", "xti", "xlsx", "zip",
];

/// A kind of file that users write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileKind {
    Program,
    List,
    /// A TwinCAT project, or a part of one.
    Project,
    Configuration,
}

impl FileKind {
    /// Returns the kind of a file, judged by its name.
    pub(crate) fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?;
        if name.eq_ignore_ascii_case(CONFIG_NAME) {
            Some(Self::Configuration)
        } else if is_program(path, None) {
            Some(Self::Program)
        } else if is_list(path) {
            Some(Self::List)
        } else if is_parameters(path) {
            Some(Self::Project)
        } else {
            None
        }
    }

    /// Returns the name used in errors.
    pub(crate) fn as_str(self) -> &'static str {
        match self {
            Self::Program => "program",
            Self::List => "list",
            Self::Project => "project",
            Self::Configuration => "configuration",
        }
    }
}

/// Returns whether a file of a folder is a program, judged by its name; `extensions` are those that the configuration
/// of the folder names.
pub fn is_program(path: &Path, extensions: Option<&[String]>) -> bool {
    match extensions {
        Some(extensions) => has_extension(path, extensions),
        None => has_extension(path, &EXTENSIONS),
    }
}

/// Returns whether a file is one that users write: a program, a list or a configuration, judged by its name.
pub fn is_source(path: &Path, extensions: Option<&[String]>) -> bool {
    FileKind::of(path).is_some() || is_program(path, extensions)
}

/// Returns whether a file is plainly something else than a program, judged by its name: that of a document, a source,
/// data, or what a system or an editor leaves beside a file.
pub(crate) fn is_known_otherwise(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with("._") || name.starts_with(".#") || has_extension(path, OTHER_EXTENSIONS)
}

/// Returns whether a file is a list of the control, judged by its name.
pub(crate) fn is_list(path: &Path) -> bool {
    has_extension(path, &["lis"])
}

/// Returns whether a file holds parameters of the control: a list, a TwinCAT project or a part of one, judged by its
/// name.
pub(crate) fn is_parameters(path: &Path) -> bool {
    is_list(path) || is_project(path) || has_extension(path, &["xti"])
}

/// Returns whether a file is a TwinCAT project, judged by its name.
pub(crate) fn is_project(path: &Path) -> bool {
    has_extension(path, &["tsproj"])
}

pub(crate) fn has_extension(path: &Path, extensions: &[impl AsRef<str>]) -> bool {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| {
        let mut known = extensions.iter();
        known.any(|known| known.as_ref().eq_ignore_ascii_case(extension))
    })
}
