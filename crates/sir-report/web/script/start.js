// Start.

async function main() {
  let viewer = null;
  applyTheme(null);
  addThemeButton(() => viewer);
  const facts = attempt(() => JSON.parse(byId('facts').textContent));
  if (!facts) return showMessage('The data of this page cannot be read.');
  for (const part of [writeHeader, writeNotices, writeComputed, writeGroups, writeBalance, writeConvergence, writeSensors, writeRepeat]) attempt(part, facts);
  viewer = await startViewer(facts);
  followRun(facts, viewer);
  return viewer;
}

main().catch(fail);
