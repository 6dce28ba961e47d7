/** Keyboard commands. Keys that the focused control uses are left to it. */

export interface Commands {
  toggle(): void;
  step(frames: number): void;
  stepSecond(direction: number): void;
  toEnd(last: boolean): void;
  faster(steps: number): void;
  nextColours(): void;
  toggleBoxes(): void;
  toggleContacts(): void;
  toggleCharts(): void;
  togglePanels(): void;
  follow(): void;
  reframe(): void;
  copyLink(): void;
  deselect(): void;
  help(): void;
}

export function listenToKeys(commands: Commands): void {
  window.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const focus = event.target instanceof HTMLElement ? event.target : document.body;
    if (focus.closest("dialog[open]") || focus.tagName === "SELECT") return;
    if (event.key === " " && focus.tagName === "BUTTON") return;
    const act = actions(commands, event.shiftKey)[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });
}

function actions(commands: Commands, shift: boolean): Record<string, () => void> {
  const go = (direction: number) => () => (shift ? commands.stepSecond(direction) : commands.step(direction));
  return {
    " ": commands.toggle,
    ArrowLeft: go(-1),
    ArrowRight: go(1),
    Home: () => commands.toEnd(false),
    End: () => commands.toEnd(true),
    "+": () => commands.faster(1),
    "=": () => commands.faster(1),
    "-": () => commands.faster(-1),
    c: commands.nextColours,
    b: commands.toggleBoxes,
    n: commands.toggleContacts,
    g: commands.toggleCharts,
    h: commands.togglePanels,
    f: commands.follow,
    r: commands.reframe,
    l: commands.copyLink,
    Escape: commands.deselect,
    "?": commands.help,
  };
}
