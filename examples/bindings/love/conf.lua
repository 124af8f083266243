function love.conf(game)
  game.identity = "libmassspring-car"
  game.window.title = "libmassspring: a soft car"
  game.window.width, game.window.height = 1120, 630
  game.window.resizable = true
  game.window.msaa = 4
  game.modules.physics = false
end
