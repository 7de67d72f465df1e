// How to repeat it, theme.

function writeRepeat(facts) {
  const commands = facts.repeat ?? [];
  if (commands.length === 0) return;
  const text = commands.map((command) => cut(command, 4000)).join('\n');
  byId('repeat-text').textContent = text;
  byId('repeat-copy').addEventListener('click', () => copyText(text, byId('repeat-copy'), byId('repeat')));
  byId('repeat').hidden = false;
}

/** Sets light or dark. Without a choice, the page follows the system. */
function applyTheme(choice) {
  const theme = choice ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
  root.dataset.theme = theme;
  byId('theme').setAttribute('aria-pressed', String(theme === 'dark'));
}

function addThemeButton(getViewer) {
  byId('theme').addEventListener('click', () => {
    const theme = root.dataset.theme === 'dark' ? 'light' : 'dark';
    applyTheme(theme);
    const viewer = getViewer();
    if (!viewer) return;
    viewer.state.theme = theme;
    viewer.changed();
  });
}
