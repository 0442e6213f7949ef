MODULE M
  PROC main()
    Stop;
    Set do1;
    quit;
    Set do2;
  ENDPROC
  PROC quit()
    EXIT;
  ENDPROC
ENDMODULE
