// Files on their way into the page: dropped, picked, or a whole folder.

/** A file with the path that the engine knows it by. */
export interface Incoming {
  path: string;
  file: Blob;
  /** Whether the user picked the file individually, and not with its folder. */
  named: boolean;
}

/** Files that came in, and files that were left out. */
export interface Intake {
  incoming: Incoming[];
  leftOut: number;
}

/** More files of folders are left out. */
export const MOST_FILES = 5000;

/** Larger files of folders are left out unless they are programs, lists or recordings. */
const LARGE = 1 << 20;

/** Larger files are not accepted. */
const LARGEST = 1 << 29;

const TEXT = /\.(nc|cnc|mpf|spf|sub|cyc|iso|ngc|tap|lis|toml|csv|tsv)$/i;

/** Folders that contain no programs. */
const SKIPPED = /^(\.|node_modules$|target$)/;

/** Returns whether a file of a folder is worth reading. */
export function isTaken(path: string, size: number): boolean {
  const parts = path.split("/");
  const name = parts.pop() ?? "";
  if (parts.some((folder) => SKIPPED.test(folder)) || name.startsWith(".") || size > LARGEST) {
    return false;
  }
  return TEXT.test(name) || size <= LARGE;
}

/** A path as the engine accepts it: no root, no way up, `/` between its parts. */
export function tidy(path: string): string {
  const parts = path.replace(/\\/g, "/").split("/");
  return parts.filter((part) => part !== "" && part !== "." && part !== "..").join("/");
}

/** A folder as newer browsers give it; the types of TypeScript lack its parts. */
type Handle = FileSystemFileHandle | FolderHandle;

interface FolderHandle extends FileSystemHandle {
  readonly kind: "directory";
  values(): AsyncIterable<Handle>;
}

interface HandedItem extends DataTransferItem {
  getAsFileSystemHandle?(): Promise<Handle | null>;
}

/** The dropped files. All of them have to be requested before anything else happens. */
export async function dropped(transfer: DataTransfer): Promise<Intake> {
  const items = [...transfer.items].filter((item) => item.kind === "file");
  const handed = items.map((item: HandedItem) => ({
    entry: item.webkitGetAsEntry(),
    file: item.getAsFile(),
    // For a page that is itself a file, Chromium opens handles, but not entries.
    handle: item.getAsFileSystemHandle?.().catch(() => null) ?? Promise.resolve(null),
  }));
  const intake: Intake = { incoming: [], leftOut: 0 };
  for (const { entry, file, handle } of handed) {
    if (entry?.isDirectory) {
      const folder = await handle;
      await (folder ? walkHandle(folder, folder.name, intake) : walkEntry(entry, intake));
    } else if (file) {
      take(intake, { path: tidy(file.name), file, named: true });
    }
  }
  return intake;
}

/** The picked files; those of a picked folder carry their path in it. */
export function picked(files: readonly File[]): Intake {
  const intake: Intake = { incoming: [], leftOut: 0 };
  for (const file of files) {
    const path = tidy(file.webkitRelativePath || file.name);
    take(intake, { path, file, named: !file.webkitRelativePath });
  }
  return intake;
}

function take(intake: Intake, incoming: Incoming): void {
  const { path, file, named } = incoming;
  const isWanted = named ? file.size <= LARGEST : isTaken(path, file.size);
  if (path !== "" && isWanted && intake.incoming.length < MOST_FILES) {
    intake.incoming.push(incoming);
  } else {
    intake.leftOut += 1;
  }
}

function isSkipped(name: string, intake: Intake): boolean {
  const isSkipped = SKIPPED.test(name) || intake.incoming.length >= MOST_FILES;
  intake.leftOut += isSkipped ? 1 : 0;
  return isSkipped;
}

async function walkHandle(handle: Handle, path: string, intake: Intake): Promise<void> {
  if (handle.kind === "file") {
    take(intake, { path: tidy(path), file: await handle.getFile(), named: false });
  } else if (!isSkipped(handle.name, intake)) {
    for await (const below of handle.values()) {
      await walkHandle(below, `${path}/${below.name}`, intake);
    }
  }
}

async function walkEntry(entry: FileSystemEntry, intake: Intake): Promise<void> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => {
      (entry as FileSystemFileEntry).file(resolve, reject);
    });
    take(intake, { path: tidy(entry.fullPath), file, named: false });
    return;
  }
  if (isSkipped(entry.name, intake)) {
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  for (;;) {
    // A reader returns a folder piece by piece, and nothing at its end.
    const piece = await new Promise<FileSystemEntry[]>((resolve, reject) => {
      reader.readEntries(resolve, () => {
        reject(new Error("This browser does not open a dropped folder: use \u201cChoose a folder\u201d."));
      });
    });
    if (piece.length === 0) {
      return;
    }
    for (const below of piece) {
      await walkEntry(below, intake);
    }
  }
}
