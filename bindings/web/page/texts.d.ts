// Files that the bundler turns into texts.

declare module "*.nc" {
  const text: string;
  export default text;
}
declare module "*.lis" {
  const text: string;
  export default text;
}
declare module "*.toml" {
  const text: string;
  export default text;
}

/** The source of the worker, from the bundler. */
declare const WORKER: string;

/** The version of frictcomp, from the bundler. */
declare const VERSION: string;
