// The page of `flexion view`: a run in motion, or modes of vibration.
import "./style.css";
import { tag } from "./curves";
import { read } from "./data";
import { modes } from "./modes";
import { motion } from "./motion";
import { Room } from "./room";

const results = read();
const element = (id: string) => document.getElementById(id)!;
element("title").textContent = results.title || results.name;
document.title = `${results.title || results.name} – Flexion`;
const room = new Room(element("subtitle"));
element("answer").append(room.stage, room.curves);
element("answer").after(room.footer);
try {
  if (results.modes) modes(results, room);
  else motion(results, room);
} catch (error) {
  room.note.replaceChildren(tag("strong", {}, `This page cannot be drawn here: ${(error as Error).message}.`));
  throw error;
}
