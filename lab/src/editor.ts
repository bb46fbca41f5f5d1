// The case as text: an editor with colours, completion, and the messages at their lines.
import { autocompletion, completionKeymap, type CompletionContext } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { setDiagnostics, lintKeymap, type Diagnostic } from "@codemirror/lint";
import { EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Problem, Schema } from "./engine";
import { place, words } from "./words";

/** TOML, line by line. */
const toml = StreamLanguage.define<{ value: boolean }>({
  name: "toml",
  startState: () => ({ value: false }),
  token: (stream, state) => {
    if (stream.sol()) state.value = false;
    if (stream.eatSpace()) return null;
    if (stream.match(/^#.*/)) return "comment";
    if (stream.match(/^"(?:[^"\\]|\\.)*"?/) || stream.match(/^'[^']*'?/)) return "string";
    if (!state.value && stream.match(/^\[{1,2}[^\]]*\]{1,2}/)) return "heading";
    if (stream.match(/^[\w.-]+(?=\s*=)/)) return "propertyName";
    if (stream.eat("=")) state.value = true;
    else if (stream.match(/^(true|false)\b/)) return "bool";
    else if (stream.match(/^[+-]?[\d.][\d._eE+-]*/)) return "number";
    else stream.next();
    return null;
  },
  languageData: { commentTokens: { line: "#" } },
});

const colours = HighlightStyle.define([
  { tag: tags.comment, color: "var(--dim)" },
  { tag: tags.string, color: "var(--good)" },
  { tag: tags.heading, color: "var(--accent)", fontWeight: "600" },
  { tag: tags.number, color: "var(--curve1)" },
  { tag: tags.bool, color: "var(--curve3)" },
]);

export class Editor {
  private readonly view: EditorView;
  private silent = false;
  schema?: Schema;

  constructor(into: HTMLElement, edited: (text: string) => void) {
    const state = EditorState.create({
      extensions: [
        lineNumbers(),
        history(),
        drawSelection(),
        highlightActiveLine(),
        EditorView.lineWrapping,
        toml,
        syntaxHighlighting(colours),
        autocompletion({ override: [(context) => this.complete(context)], icons: false }),
        keymap.of([...completionKeymap, ...lintKeymap, ...historyKeymap, ...defaultKeymap]),
        EditorView.contentAttributes.of({ "aria-label": "The case as text", spellcheck: "false" }),
        EditorView.updateListener.of((update) => {
          if (update.docChanged && !this.silent) edited(this.text);
        }),
      ],
    });
    this.view = new EditorView({ state, parent: into });
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** Shows another text, of which only what differs is changed. */
  set text(text: string) {
    const old = this.text;
    if (old === text) return;
    let [from, end] = [0, 0];
    while (from < Math.min(old.length, text.length) && old[from] === text[from]) from++;
    while (end < Math.min(old.length, text.length) - from && old.at(-1 - end) === text.at(-1 - end)) end++;
    this.silent = true;
    this.view.dispatch({ changes: { from, to: old.length - end, insert: text.slice(from, text.length - end) } });
    this.silent = false;
  }

  /** Shows problems at their lines. */
  report(problems: Problem[]) {
    const { doc } = this.view.state;
    const shown = problems.slice(0, 200).map((problem): Diagnostic => {
      const line = doc.line(Math.min(Math.max(problem.line ?? 1, 1), doc.lines));
      const from = Math.min(line.from + Math.max((problem.column ?? 1) - 1, 0), line.to);
      const to = Math.min(problem.length ? from + problem.length : line.to, line.to);
      const severity = problem.severity === "warning" ? "warning" : "error";
      const message = [problem.message, problem.label, ...(problem.help ?? [])].filter(Boolean).join("\n");
      return { from, to: Math.max(from, to), severity, message };
    });
    this.view.dispatch(setDiagnostics(this.view.state, shown));
  }

  /** Puts the cursor at a line. */
  go(line: number, column = 1) {
    const at = this.view.state.doc.line(Math.min(Math.max(line, 1), this.view.state.doc.lines));
    const head = Math.min(at.from + column - 1, at.to);
    this.view.dispatch({ selection: { anchor: head }, effects: EditorView.scrollIntoView(head, { y: "center" }) });
    this.view.focus();
  }

  private complete(context: CompletionContext) {
    if (!this.schema) return null;
    const { doc } = context.state;
    const here = place(doc.sliceString(0, context.pos), doc.sliceString(context.pos));
    if (!context.explicit && here.begun === "" && here.key === undefined) return null;
    const line = doc.lineAt(context.pos);
    if (doc.sliceString(line.from, context.pos).trimStart().startsWith("#")) return null;
    const quoted = /["'][^"'=,]*$/.test(doc.sliceString(line.from, context.pos));
    const bare = (word: string) => quoted || /^(true|false|\{.*|[\d.]+)$/.test(word);
    return {
      from: context.pos - here.begun.length,
      options: words(this.schema, here).map(({ word, meaning, text }) => ({
        label: word,
        detail: meaning.length > 60 ? undefined : meaning,
        info: meaning.length > 60 ? meaning : undefined,
        apply: here.key === undefined || bare(word) ? text : `"${text}"`,
      })),
      validFor: /^[\w -]*$/,
    };
  }
}
