// What VS Code cannot be told in package.json: where the debug adapter is, the STL status beside the lines, tasks, and commands
// for requests that the Debug Adapter Protocol has not. Everything else is done by the command s7200.
"use strict";
const { execFile } = require("node:child_process");
const path = require("node:path");
const vscode = require("vscode");

const TYPE = "s7200";
const PROGRAMS = [{ language: "s7200-stl" }, { language: "plaintext" }];  // a published listing is a text

const command = () => vscode.workspace.getConfiguration("s7200").get("path") || "s7200";

// VS Code itself says nothing about a command that is not in the path: the session just does not begin.
function runs(file) {
  return new Promise((resolve, reject) => {
    execFile(file, ["--version"], (error) => {
      const advice = "Put s7200 in the path, or say where it is in the setting s7200.path.";
      if (error) reject(new Error(`Cannot run '${file}' (${error.message}). ${advice}`));
      else resolve();
    });
  });
}

const adapters = {
  async createDebugAdapterDescriptor(session) {
    const { request, port } = session.configuration;
    if (request === "attach") return new vscode.DebugAdapterServer(port, "127.0.0.1");
    await runs(command());
    return new vscode.DebugAdapterExecutable(command(), ["dap"]);
  },
};

// The server prints a token, without which it lets nobody in. No session begins if none is typed.
async function withToken(configuration) {
  const token = await vscode.window.showInputBox({
    prompt: "The token that 's7200 dap --listen' has printed", ignoreFocusOut: true,
  });
  return token ? { ...configuration, token: token.trim() } : undefined;
}

// F5 without a launch.json debugs the program in the editor.
const configurations = {
  resolveDebugConfiguration(folder, configuration) {
    const needsToken = configuration.request === "attach" && !configuration.token;
    if (configuration.type) return needsToken ? withToken(configuration) : configuration;
    const editor = vscode.window.activeTextEditor;
    if (!editor || !PROGRAMS.some(({ language }) => language === editor.document.languageId)) {
      vscode.window.showInformationMessage("Open the STL program that is to be debugged.");
      return undefined;
    }
    return { type: TYPE, request: "launch", name: "Debug this STL program", program: editor.document.uri.fsPath, stopOnEntry: true };
  },
  provideDebugConfigurations() {
    return [{ type: TYPE, request: "launch", name: "Debug this STL program", program: "${file}", stopOnEntry: true }];
  },
};

// STL status: power flow and operands of each line's last execution.
async function statusOf(document, first, last) {
  const session = vscode.debug.activeDebugSession;
  if (!session || session.type !== TYPE || !vscode.workspace.getConfiguration("s7200").get("status")) return [];
  const { lines } = await session.customRequest("stlStatus", {
    source: { path: document.uri.fsPath }, line: first + 1, endLine: last + 1,
  });
  return lines;
}

const status = {
  async provideInlineValues(document, viewport, context) {
    const lines = await statusOf(document, viewport.start.line, viewport.end.line);
    return lines.map(({ line, text }) => new vscode.InlineValueText(document.lineAt(line - 1).range, text));
  },
};

const S0_IS = "S0 is the power flow behind a contact, and in front of a coil, box or call.";

const statusHover = {
  async provideHover(document, position) {
    const [last] = await statusOf(document, position.line, position.line);
    if (!last) return undefined;
    return new vscode.Hover([last.text, last.powerFlow ? S0_IS : `Passed without power flow. ${S0_IS}`]);
  },
};

const OPERAND = /[*&]?[A-Za-z]+\d+(?:\.\d)?|"[^"\n]*"|[A-Za-z_]\w*/;

// What VS Code asks the value of while somebody points at it. On its own it would ask for M31 of M31.7.
const operands = {
  provideEvaluatableExpression(document, position) {
    const range = document.getWordRangeAtPosition(position, OPERAND);
    return range && new vscode.EvaluatableExpression(range);
  },
};

// The problem matcher takes full paths: for others VS Code looks for the file, problem by problem, and it stops 100 ms after the task.
const in_workspace = (file) => (path.isAbsolute(file) || file.startsWith("${") ? file : `\${workspaceFolder}/${file}`);

function task(definition) {
  const { verb, file } = definition;
  const execution = new vscode.ProcessExecution(command(), [verb, in_workspace(file), ...(definition.arguments || [])]);
  return new vscode.Task(definition, vscode.TaskScope.Workspace, `${verb} ${file}`, TYPE, execution, "$s7200");
}

const tasks = {
  provideTasks() {
    const check = task({ type: TYPE, verb: "check", file: "${file}" });
    check.group = vscode.TaskGroup.Build;
    return [check, task({ type: TYPE, verb: "test", file: "${file}" })];
  },
  resolveTask: ({ definition }) => task(definition),
};

// The PLC of a system whose stack is selected, or the first one.
function looksAt(session) {
  const item = vscode.debug.activeStackItem;
  return item && item.session.id === session.id ? item.threadId : 1;
}

// Asks what is missing, and sends the request; what comes back as text goes to the debug console.
async function ask(request, argument, prompt, placeHolder) {
  const session = vscode.debug.activeDebugSession;
  if (!session || session.type !== TYPE) return vscode.window.showInformationMessage("No S7-200 program is being debugged.");
  const args = { threadId: looksAt(session) };
  if (argument) {
    args[argument] = await vscode.window.showInputBox({ prompt, placeHolder });
    if (!args[argument]) return undefined;
  }
  const body = await session.customRequest(request, args).catch(() => undefined);  // VS Code itself shows a refusal
  const text = body?.text ?? body?.instructions?.map((one) => `${one.time.padStart(15)}  ${one.text}`).join("\n");
  if (text) vscode.debug.activeDebugConsole.appendLine(text.trimEnd());
  return undefined;
}

const WRITTEN = ["expression", "An address, or an event: who wrote it, or attached it", "VW3300, or event 8"];

const COMMANDS = {
  reverseStepOver: [],
  reverseStepOut: [],
  stepScan: [],
  reverseStepScan: [],
  stepInterrupt: [],
  reverseStepInterrupt: [],
  lastWrite: WRITTEN,
  reverseToLastWrite: WRITTEN,
  lastDecision: [],
  reverseToLastDecision: [],
  goToMoment: ["time", "A moment since power-up", "15.193ms, -5ms, start, end"],
  sendFrame: ["frame", "A frame in hex, or text in quotation marks", "01 03 00 0a 00 01 crc"],
  fault: ["fault", "A fault of the line from now on, as --fault takes it; or none", "flip:character=3,bit=5, or none"],
  force: ["values", "What is to hold a value across scans", "I0.3=1 VW10=5"],
  unforce: ["places", "What is to be released", "I0.3, or all"],
  timeline: [],
  lastInstructions: [],
};

function activate(context) {
  context.subscriptions.push(
    vscode.debug.registerDebugAdapterDescriptorFactory(TYPE, adapters),
    vscode.debug.registerDebugConfigurationProvider(TYPE, configurations, vscode.DebugConfigurationProviderTriggerKind.Dynamic),
    vscode.languages.registerInlineValuesProvider(PROGRAMS, status),
    vscode.languages.registerHoverProvider(PROGRAMS, statusHover),
    vscode.languages.registerEvaluatableExpressionProvider(PROGRAMS, operands),
    vscode.tasks.registerTaskProvider(TYPE, tasks),
    ...Object.entries(COMMANDS).map(([name, args]) =>
      vscode.commands.registerCommand(`s7200.${name}`, () => ask(name, ...args))));
}

module.exports = { activate, deactivate() {} };
