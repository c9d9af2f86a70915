import js from "@eslint/js";
import tseslint from "typescript-eslint";

export default tseslint.config(
  { ignores: ["dist/", "node_modules/"] },
  js.configs.recommended,
  {
    files: ["**/*.ts"],
    extends: [tseslint.configs.strictTypeChecked, tseslint.configs.stylisticTypeChecked],
    languageOptions: { parserOptions: { projectService: true } },
    rules: {
      "@typescript-eslint/restrict-template-expressions": ["error", { allowNumber: true }],
    },
  },
  {
    files: ["**/*.mjs"],
    languageOptions: {
      globals: {
        process: "readonly", console: "readonly", document: "readonly", window: "readonly",
        Buffer: "readonly", WebAssembly: "readonly", TextEncoder: "readonly", performance: "readonly",
        URL: "readonly", getComputedStyle: "readonly", fetch: "readonly", setTimeout: "readonly",
      },
    },
  },
);
