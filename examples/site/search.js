// Finds headings of the guides and names of the reference: siteIndex, which pages.mjs has written, is a list of
// [words, page].
'use strict';
(() => {
  const MOST = 12;
  const root = new URL('.', document.currentScript.src);
  for (const field of document.querySelectorAll('[data-search]')) {
    const list = document.createElement('ul');
    list.className = 'found';
    list.hidden = true;
    field.after(list);
    field.addEventListener('input', () => {
      const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      const fits = ([text]) => words.length > 0 && words.every((word) => text.toLowerCase().includes(word));
      const found = globalThis.siteIndex.filter(fits);
      // What begins with the words comes first, then what is short.
      const rank = ([text]) => (text.toLowerCase().startsWith(words[0]) ? 0 : 1000) + text.length;
      list.replaceChildren(...found.sort((a, b) => rank(a) - rank(b)).slice(0, MOST).map(([text, page]) => {
        const line = document.createElement('li'), link = document.createElement('a');
        link.href = new URL(page, root);
        link.textContent = text;
        line.append(link);
        return line;
      }));
      list.hidden = !found.length;
    });
    field.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') list.querySelector('a')?.click();
      if (event.key === 'Escape') list.hidden = true;
    });
  }
})();
