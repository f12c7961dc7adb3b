"use strict";
// Starts `tltlc lsp` for task files.
const { workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = () => {
  const command = workspace.getConfiguration("tltl").get("server.path");
  const server = { command, args: ["lsp"] };
  client = new LanguageClient("tltl", "tltl", server, { documentSelector: [{ language: "tltl" }] });
  return client.start();
};

exports.deactivate = () => client && client.stop();
