// A run that goes on: newer light from the server of the page.

/** Time between two questions to the server, in milliseconds. */
const QUESTION_PAUSE = 1000;

/** Follows the run, if the page comes from its server: shows newer light, how far the run is, and a button that ends it. */
function followRun(facts, viewer) {
  if (!facts.live) return;
  let { version } = facts.live;
  const status = element('p', { id: 'run-status', role: 'status' }, 'The run goes on.');
  const end = element('button', { type: 'button', id: 'run-end', on: { click: endRun } }, 'Good enough: end the run');
  const bar = element('div', { class: 'run', id: 'run' }, status, end);
  document.querySelector('header.top').after(bar);
  setTimeout(ask, QUESTION_PAUSE);

  async function ask() {
    try {
      const answer = await (await fetch('version', { cache: 'no-store' })).json();
      if (answer.final) return location.reload();
      status.textContent = answer.status;
      if (answer.version > version) {
        version = answer.version;
        const text = await (await fetch('mesh', { cache: 'no-store' })).text();
        if (viewer) viewer.replaceLight(await readMesh(text));
        root.dataset.version = String(version);
      }
      setTimeout(ask, QUESTION_PAUSE);
    } catch {
      status.textContent = 'The run has ended, or was interrupted. The page shows the light that it had.';
      end.remove();
    }
  }

  async function endRun() {
    end.disabled = true;
    end.textContent = 'Ends after this repeat';
    await fetch('end', { method: 'POST' }).catch(() => null);
  }
}
