// The page run with settings in its address until it writes what came of it: the lines, and a picture.
//
//   node show.js PAGE.html SETTINGS [PICTURE.png]
'use strict';
const { writeFileSync } = require('node:fs');
const { resolve } = require('node:path');
const { Browser } = require('./browser.js');

const [page, settings, picture] = process.argv.slice(2);
const browser = new Browser();

async function show() {
  await browser.open(`file://${resolve(page)}#${settings}`, 1200, 660);
  await browser.until('document.getElementById("written") !== null', 'the page has run');
  console.log(await browser.value('document.getElementById("written").textContent'));
  if (picture) writeFileSync(picture, await browser.picture());
  if (browser.complaints.length) throw new Error(browser.complaints.join('\n'));
}

show().then(() => 0, (problem) => (console.error(problem), 1)).then(async (status) => {
  await browser.close();
  process.exit(status);
});
