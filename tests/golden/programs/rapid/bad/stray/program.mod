MODULE M
  Set do1;
  Reset do1;
  !%DRAW_SCENE
  PROC main()
  ENDPROC
  n:=1;
ENDMODULE
