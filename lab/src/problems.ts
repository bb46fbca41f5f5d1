// What is wrong with a case, as a list that leads to its places.
import { tag } from "./curves";
import type { Problem } from "./engine";

/** Most that are listed. */
const MOST = 20;

/** Lists problems; `go` leads to the place of one. */
export function list(into: HTMLElement, problems: Problem[], go: (problem: Problem) => void) {
  const nodes = problems.slice(0, MOST).map((problem) => {
    const button = tag("button", { type: "button" }, problem.line ? `Line ${problem.line}` : (problem.key ?? "Case"));
    button.addEventListener("click", () => go(problem));
    const help = [problem.label, ...(problem.help ?? [])].filter(Boolean).join("; ");
    const key = problem.key && problem.line ? `${problem.key}: ` : "";
    return tag("li", {}, button, ` ${key}${problem.message}`, ...(help ? [tag("small", {}, help)] : []));
  });
  if (problems.length > nodes.length) nodes.push(tag("li", {}, `and ${problems.length - nodes.length} more`));
  into.replaceChildren(...nodes);
}
