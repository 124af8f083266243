// Script of all pages, without figures and search: the playground in its frame, and buttons that copy code.
'use strict';
(() => {
  for (const button of document.querySelectorAll('[data-copy]')) {
    if (!navigator.clipboard) continue;
    button.hidden = false;
    button.addEventListener('click', async () => {
      await navigator.clipboard.writeText(button.parentElement.querySelector('code').textContent);
      button.textContent = 'Copied';
      setTimeout(() => (button.textContent = 'Copy'), 2000);
    });
  }

  const place = document.querySelector('.playground');
  if (!place || typeof WebAssembly === 'undefined') return;
  document.querySelector('.without').hidden = true;
  const buttons = document.querySelector('.scenes');
  buttons.hidden = false;
  let frame;
  function show(settings) {
    frame?.remove();
    frame = document.createElement('iframe');
    frame.title = 'Playground';
    frame.allow = 'clipboard-write';
    frame.src = `massspring.html#embed=1&${settings}`;
    place.classList.remove('runs');
    place.append(frame);
    buttons.querySelector('a').href = `massspring.html#${settings}`;
    for (const button of buttons.querySelectorAll('button'))
      button.setAttribute('aria-pressed', String(button.dataset.scene === settings));
  }
  // The still picture stays until something is drawn over it. If the scene is slow, a lighter one replaces it, once.
  let chosen = innerWidth < 700;
  addEventListener('message', ({ source, data }) => {
    if (source !== frame?.contentWindow) return;
    if (data === 'massspring runs') place.classList.add('runs');
    if (data === 'massspring is slow' && !chosen) {
      chosen = true;
      show(place.dataset.narrow);
    }
  });
  for (const button of buttons.querySelectorAll('button'))
    button.addEventListener('click', () => {
      chosen = true;
      show(button.dataset.scene);
    });
  show(chosen ? place.dataset.narrow : place.dataset.wide);
})();
