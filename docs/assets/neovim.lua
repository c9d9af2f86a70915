-- frictcomp in Neovim 0.11 or later: put this file into `lsp/frictcomp.lua` of your configuration,
-- and `vim.lsp.enable("frictcomp")` into `init.lua`.
return {
  cmd = { "frictcomp", "lsp" },
  filetypes = { "isg-cnc", "isg-list", "toml" },
  root_markers = { "frictcomp.toml", ".git" },
  init_options = {
    -- No other extension offers these in Neovim.
    isgExtension = false,
    inlayHints = { enable = true },
    codeLens = { enable = true },
  },
}
