/** The buttons that show or hide something. */
import { byId } from "./dom";

export class SwitchButton {
  private readonly button: HTMLButtonElement;

  constructor(
    id: string,
    private readonly act: (on: boolean) => void,
  ) {
    this.button = byId<HTMLButtonElement>(id);
  }

  get on(): boolean {
    return this.button.getAttribute("aria-pressed") === "true";
  }
  set on(on: boolean) {
    this.button.setAttribute("aria-pressed", String(on));
    this.act(on);
  }
}
