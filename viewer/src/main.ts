// Which page it is, told by its data: that of a run or that of a study.
import { failed } from "./parts.ts";
import { read_page } from "./run.ts";
import { open_run } from "./run_page.ts";
import { open_study } from "./study_page.ts";

async function open_page(): Promise<void> {
  const page = read_page(document);
  await ("kind" in page ? open_study(page) : open_run(page));
}

open_page().catch((error: unknown) => failed(error instanceof Error ? error.message : String(error)));
