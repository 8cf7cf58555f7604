// Start the language server `deixis lsp` for layout scripts and texts in English, and stop it with the editor.

const { window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

async function activate() {
  const settings = workspace.getConfiguration("deixis");
  const [command, ...args] = settings.get("command");
  const documentSelector = [{ language: "deixis-layout" }];
  if (settings.get("english")) {
    documentSelector.push({ language: "plaintext" });
  }
  client = new LanguageClient("deixis", "Deixis", { command, args }, { documentSelector });
  try {
    await client.start();
  } catch (error) {
    const advice = "Install it (pip install 'deixis[lsp]'), or set deixis.command to its path.";
    window.showErrorMessage(`Deixis: '${command}' cannot be started (${error.message}). ${advice}`);
  }
}

async function deactivate() {
  await client?.dispose();
}

module.exports = { activate, deactivate };
