"use strict";
// Starts `tltlc lsp` for task files, and again where the setting of its path changes.
const { commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function start() {
  const command = workspace.getConfiguration("tltl").get("server.path");
  const server = { command, args: ["lsp"] };
  client = new LanguageClient("tltl", "tltl", server, { documentSelector: [{ language: "tltl" }] });
  try {
    await client.start();
  } catch {
    client = undefined;
    const settings = "Open Settings";
    const chosen = await window.showErrorMessage(
      `The language server of tltl does not start: is \`${command}\` installed? Without it there are colours only.`,
      settings,
    );
    if (chosen === settings) commands.executeCommand("workbench.action.openSettings", "tltl.server.path");
  }
}

const stop = () => client && client.stop();

exports.activate = (context) => {
  const changed = workspace.onDidChangeConfiguration(async (event) => {
    if (!event.affectsConfiguration("tltl.server.path")) return;
    await stop();
    start();
  });
  context.subscriptions.push(changed);
  // Not awaited: a message that waits for its reader would keep the editor waiting too.
  start();
};

exports.deactivate = stop;
