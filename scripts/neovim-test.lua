-- Opens a program in a headless Neovim with the settings of `docs/assets/neovim.lua`, and reads back what the
-- server shows. Arguments: the settings, the tool, a folder to work in.
local settings, tool, folder = arg[1], arg[2], arg[3]

local function write(name, lines)
  vim.fn.writefile(lines, folder .. "/" .. name)
end

local function expect(what, found, wanted)
  if not tostring(found):find(wanted, 1, true) then
    error(("%s: %s has no %q"):format(what, vim.inspect(found), wanted), 0)
  end
  print("ok: " .. what)
end

local function wait(what, condition)
  if not vim.wait(30000, condition, 20) then
    error(what .. ": nothing came", 0)
  end
end

local function test()
  write("frictcomp.toml", { "[[axis]]", 'name = "X"', "enable = true" })
  write("a.nc", { "M30" })
  vim.filetype.add({ extension = { nc = "isg-cnc", lis = "isg-list" } })
  local config = dofile(settings)
  config.cmd[1] = tool
  vim.lsp.config("frictcomp", config)
  vim.lsp.enable("frictcomp")

  vim.cmd.edit(folder .. "/a.nc")
  local lines = { "N10 G90", "N20 X[COMP OFF FRICT]", "N30 X[COMP OFF FRIKT]", "N40 M30" }
  vim.api.nvim_buf_set_lines(0, 0, -1, false, lines)

  local function said()
    return vim.diagnostic.get(0)
  end
  wait("diagnostics", function()
    return #said() == 2
  end)
  table.sort(said(), function(one, other)
    return one.lnum < other.lnum
  end)
  local codes = vim.tbl_map(function(it)
    return ("%s:%d"):format(it.code, it.lnum)
  end, said())
  table.sort(codes)
  expect("diagnostics", table.concat(codes, " "), "FC202:2 FC401:1")

  local at = { textDocument = vim.lsp.util.make_text_document_params(), position = { line = 1, character = 8 } }
  local function ask(method, params)
    local answers = vim.lsp.buf_request_sync(0, method, params, 30000) or {}
    for _, answer in pairs(answers) do
      return answer.result
    end
  end
  expect("hover", ask("textDocument/hover", at).contents.value, "| X | active | inactive |")

  vim.lsp.inlay_hint.enable(true)
  wait("inlay hints", function()
    return #vim.lsp.inlay_hint.get({ bufnr = 0 }) == 2
  end)
  local hints = vim.tbl_map(function(it)
    return it.inlay_hint.label
  end, vim.lsp.inlay_hint.get({ bufnr = 0 }))
  expect("inlay hints", table.concat(hints, "; "), "X: active → inactive")
  expect("inlay hints", table.concat(hints, "; "), "leaves X inactive")

  -- Nothing that Enter would take in place of a line break; inside the bracket a blank is enough.
  local function offered(line, character)
    local place = { textDocument = at.textDocument, position = { line = line, character = character } }
    local labels = vim.tbl_map(function(it)
      return it.label
    end, ask("textDocument/completion", place) or {})
    return "[" .. table.concat(labels, " ") .. "]"
  end
  expect("completion after a word", offered(0, 7), "[]")
  expect("completion in the bracket", offered(1, 11), "[ON OFF OFF_ALL]")

  -- The first quick fix of the misspelt kind, applied as a user does.
  local range = { start = { line = 2, character = 0 }, ["end"] = { line = 2, character = 21 } }
  local actions = ask("textDocument/codeAction", {
    textDocument = at.textDocument,
    range = range,
    context = { diagnostics = {} },
  })
  vim.lsp.util.apply_workspace_edit(actions[1].edit, "utf-16")
  expect("quick fix", vim.api.nvim_buf_get_lines(0, 2, 3, false)[1], "N30 X[COMP OFF FRICT]")
  wait("the message goes", function()
    return vim.tbl_isempty(vim.tbl_filter(function(it)
      return it.code == "FC202"
    end, said()))
  end)
  print("ok: the message goes")

  -- The settings give the server every TOML file; it speaks about its own alone.
  write("Cargo.toml", { "[package]", 'name = "X[COMP ON FRIKT]"', "frict = 1" })
  vim.cmd.edit(folder .. "/Cargo.toml")
  vim.bo.filetype = "toml"
  wait("the server is attached", function()
    return #vim.lsp.get_clients({ bufnr = 0, name = "frictcomp" }) == 1
  end)
  vim.wait(1500, function()
    return false
  end, 100)
  expect("messages in Cargo.toml", #said(), "0")
end

local passed, failure = xpcall(test, debug.traceback)
if not passed then
  io.stderr:write(tostring(failure) .. "\n")
end
vim.cmd(passed and "qall!" or "cquit! 1")
