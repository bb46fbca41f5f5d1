// The page: a run in motion, or modes of vibration.
import "./style.css";
import { read } from "./data";
import { modes } from "./modes";
import { motion } from "./motion";
import { tag } from "./curves";

const results = read();
const element = (id: string) => document.getElementById(id)!;
element("title").textContent = results.title || results.name;
document.title = `${results.title || results.name} – Flexion`;
try {
  if (results.modes) modes(results);
  else motion(results);
} catch (error) {
  element("note").replaceChildren(tag("strong", {}, `This page cannot be drawn here: ${(error as Error).message}.`));
  throw error;
}
