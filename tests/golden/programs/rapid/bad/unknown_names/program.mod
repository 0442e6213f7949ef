MODULE M
  VAR num count;
  PROC main()
    coumt:=1;
    coumt:=coumt+1;
    count:=nothing+1;
    MoveL p9,v100,fine,tool0;
  ENDPROC
  PROC again()
    coumt:=1;
  ENDPROC
ENDMODULE
