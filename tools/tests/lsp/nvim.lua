-- A session of Neovim with the language server: what a user sees, printed line by line.
-- `TLTLC` is the tool; the file is the argument. Run by `tests/lsp.rs` where there is `nvim`.
local function say(...) io.stdout:write(string.format(...), "\n") end

local function session()
  local buffer = vim.api.nvim_get_current_buf()
  -- Neovim 0.7 has the older names of `start` and `format`, and the latest no longer has them.
  local start = vim.lsp.start or vim.lsp.start_client
  local id = start({ name = "tltlc", cmd = { os.getenv("TLTLC"), "lsp" } })
  vim.lsp.buf_attach_client(buffer, id)

  local function wait(what, check)
    if not vim.wait(10000, check, 20) then error("no " .. what) end
  end

  local function diagnostics() return vim.diagnostic.get(buffer) end

  local function ask(method, row, column, more)
    vim.api.nvim_win_set_cursor(0, { row, column })
    local params = vim.tbl_extend("force", vim.lsp.util.make_position_params(0, "utf-16"), more or {})
    local answers = vim.lsp.buf_request_sync(buffer, method, params, 10000)
    return answers[id].result, answers[id].error
  end

  wait("diagnostics", function() return #diagnostics() > 0 end)
  for _, one in ipairs(diagnostics()) do
    say("%d:%d %s: %s", one.lnum + 1, one.col, one.code or one.user_data.lsp.code, one.message:gsub("\n", " / "))
  end

  -- Mend the mistake, as one types: `bb` becomes `b`.
  local line = vim.api.nvim_buf_get_lines(buffer, 5, 6, true)[1]
  vim.api.nvim_buf_set_lines(buffer, 5, 6, true, { (line:gsub("bb", "b")) })
  wait("end of diagnostics", function() return #diagnostics() == 0 end)
  say("mended")

  say("%s", ask("textDocument/hover", 6, 5).contents.value)
  say("completion: %s", table.concat(vim.tbl_map(function(item) return item.label end,
    ask("textDocument/completion", 6, 18).items), " "))
  local there = ask("textDocument/definition", 6, 20)[1].range.start
  say("definition: %d:%d", there.line + 1, there.character)

  local edit = ask("textDocument/rename", 4, 10, { newName = "berth" })
  vim.lsp.util.apply_workspace_edit(edit, "utf-16")
  local _, refused = ask("textDocument/rename", 4, 10, { newName = "x" })
  say("refused: %s", refused.message)
  local format = vim.lsp.buf.format or function() vim.lsp.buf.formatting_sync({}, 10000) end
  format({ timeout_ms = 10000 })
  for _, text in ipairs(vim.api.nvim_buf_get_lines(buffer, 0, -1, true)) do say("| %s", text) end
  wait("silence", function() return #diagnostics() == 0 end)
end

local fine, fault = pcall(session)
if not fine then say("fault: %s", fault) end
vim.cmd("qa!")
