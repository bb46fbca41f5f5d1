// The case as text: plain as it is printed, and in an editor, which is made when it is first looked at.
import { tag } from "./curves";
import type { Editor } from "./editor";
import type { Problem, Schema } from "./engine";

declare const CaseEditor: typeof import("./editor");

/** The class of the editor. Its code is text in the page until it is needed. */
function load(): typeof Editor {
  const script = tag("script");
  script.textContent = document.getElementById("editor")!.textContent;
  document.head.append(script);
  return CaseEditor.Editor;
}

export class Source {
  private readonly plain = tag("pre", { class: "plain" });
  private editor?: Editor;
  private content = "";
  private problems: Problem[] = [];
  private keys?: Schema;

  constructor(
    private readonly into: HTMLElement,
    private readonly edited: (text: string) => void,
  ) {
    into.append(this.plain);
  }

  set text(text: string) {
    this.content = text;
    this.plain.textContent = text;
    this.renew();
  }

  /** What can be completed. */
  set schema(schema: Schema | undefined) {
    this.keys = schema;
    if (this.editor) this.editor.schema = schema;
  }

  /** Shows problems at their lines. */
  report(problems: Problem[]) {
    this.problems = problems;
    this.renew();
  }

  /** Puts the cursor at a line. */
  go(line: number, column: number) {
    this.shown().go(line, column);
  }

  /** The editor with the text: call it when it comes into view. */
  shown(): Editor {
    this.editor ??= this.made();
    this.renew();
    return this.editor;
  }

  private made(): Editor {
    const editor = new (load())(this.into, (text) => {
      this.content = this.plain.textContent = text;
      this.edited(text);
    });
    editor.schema = this.keys;
    return editor;
  }

  /** Gives the editor what has changed, if it is seen. */
  private renew() {
    if (!this.editor || this.into.hidden) return;
    this.editor.text = this.content;
    this.editor.report(this.problems);
  }
}
